// What one board is told before it starts.
#pragma once

#include <stdint.h>

#include "robot.h"
#include "telemetry.h"

namespace arboleda {

// How an axis finds its reference: it drives to its switch, backs off, comes back slowly, drives to 0.
struct HomeWay {
    int8_t direction;        // in which its switch lies: 1 or -1
    uint8_t turn;            // axes of a lower turn go first
    int32_t switch_steps;    // where the switch closes, counted from 0
    int32_t clear_steps;     // how far it backs off after the switch has opened
    float seek_steps_s;
    float creep_steps_s;  // slow enough to stop at once
};

enum class HomeBy : uint8_t {
    kSwitches,
    kKnown,  // the hardware knows where the axes are; they just drive to 0
};

// How long a switch has to be seen closed, or open, to count. Half of what a step takes at creep speed (9.9 ms and more):
// the other half is left to the contact, and no step is taken beyond the one that has closed it. The pulses that the
// ESP32 itself makes at its pins 36 and 39 last 80 ns (its errata, GPIO-3.11).
constexpr uint32_t kDebounceUs = 5000;

enum class OnStop : uint8_t { kHold, kRelease };

struct Config {
    const Robot* robot = nullptr;
    Level level = Level::kIds;
    HomeBy home_by = HomeBy::kSwitches;
    HomeWay home[kMostAxes] = {};
    uint32_t debounce_us = kDebounceUs;  // of the switches
    OnStop effector_on_stop = OnStop::kHold;
    bool has_piece_sensor = false;
    uint32_t retarget_us = 100000;  // between targets of a moving arm: no motor follows faster ones
    uint32_t stall_us = 5000;  // a step so late at speed has lost the motor; 0: time is moved by hand
};

}  // namespace arboleda
