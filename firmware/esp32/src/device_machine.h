// The core's hardware of a declared device on an ESP32: the pins of device_config.h.
#pragma once

#include "device_hardware.h"

namespace arboleda {

// The first thing of all, after whatever reset.
void make_outputs_safe();

class DeviceMachine final : public DeviceHardware {
public:
    void begin();  // after `make_outputs_safe`

    bool level(uint8_t input) override;
    uint16_t counts(uint8_t analog) override;
    void set_level(uint8_t output, bool high) override;
    void pulse(uint8_t servo, uint16_t us) override;
    void begun(const Order&) override {}
};

}  // namespace arboleda
