// What the core asks of the machine that a device is wired to; every call is short and never blocks.
#pragma once

#include <stdint.h>

#include "order.h"

namespace arboleda {

class DeviceHardware {
public:
    virtual bool level(uint8_t input) = 0;      // of its pin: high
    virtual uint16_t counts(uint8_t analog) = 0;
    virtual void set_level(uint8_t output, bool high) = 0;
    virtual void pulse(uint8_t servo, uint16_t us) = 0;  // 0: none, the servo is slack
    virtual void begun(const Order& order) = 0;          // an order is under way

protected:
    ~DeviceHardware() = default;
};

}  // namespace arboleda
