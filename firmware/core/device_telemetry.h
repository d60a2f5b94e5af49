// What the board of a device says, and how it reads on the wire.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "device.h"
#include "order_receipts.h"
#include "telemetry.h"

namespace arboleda {

struct DeviceTelemetry {
    State state = State::kStopped;
    uint32_t number = 0;  // of telemetry since boot
    OrderReceipts receipts;
    uint32_t boot_id = 0;
    double facts[kMostFacts] = {};
};

// Compact JSON in `buffer`; its length, or 0 where it does not fit.
size_t encode(const Device& device, const DeviceTelemetry& said, char* buffer, size_t capacity);

}  // namespace arboleda
