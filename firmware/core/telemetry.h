// What a board says, and how it reads on the wire.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "receipts.h"
#include "text.h"

namespace arboleda {

enum class State : uint8_t { kStopped = 0, kMoving = 1, kFault = 2, kNotHomed = 3, kLatched = 4 };

enum class Level : uint8_t { kJoints, kIds };  // joints and state only, or all of it

struct Telemetry {
    Level level = Level::kIds;
    State state = State::kStopped;
    uint8_t axes = 0;
    double q_deg[kMostAxes] = {};
    uint32_t number = 0;  // of telemetry since boot
    Receipts receipts;
    uint32_t boot_id = 0;
    bool homed = false;
    bool effector = false;
    bool has_piece_sensor = false;
    bool piece = false;
};

class Writer;

// `epoca_ack` to `rechazo_seq`; tokens only where there is room for them.
void write_receipts(Writer& writer, const Receipts& receipts, bool tokens);

// Compact JSON in `buffer`; its length, or 0 where it does not fit.
size_t encode(const Telemetry& said, char* buffer, size_t capacity);

}  // namespace arboleda
