// What the network task and the motion task hand each other; neither waits for the other.
#pragma once

#include "profile.h"
#include "ring.h"

namespace arboleda {

struct Heard {
    enum class What : uint8_t { kUp, kDown, kMessage } what = What::kDown;
    profile::Incoming message;
};

struct Said {
    bool present = false;  // `conexion` 1, else the telemetry
    profile::Outgoing telemetry;
};

struct Exchange {
    Ring<Heard, 32> heard;  // network -> motion
    Ring<Said, 32> said;    // motion -> network; full: the report is lost, the next comes in 0.1 s
    volatile bool moving = false;
    volatile uint32_t lost_steps = 0;
    volatile uint32_t refusals = 0;
};

}  // namespace arboleda
