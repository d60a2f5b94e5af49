// An order to a device: which of its verbs, with which values. Checked whole before anything acts on it.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "device.h"
#include "message.h"

namespace arboleda {

constexpr const char* kOrderChannel = "orden";

struct Order {
    Message head;        // its numbers; `well_formed`: it is an order, to whatever device
    bool known = false;  // this device has such a verb with such values
    uint8_t verb = 0;
    double values[kMostValues] = {};
};

Order decode_order(const Device& device, const uint8_t* bytes, size_t size, bool retained);

}  // namespace arboleda
