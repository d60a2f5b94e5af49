// A device that is not there: what an order moves is where it should be after the time that its kind says.
#pragma once

#include "../../core/device_board.h"

namespace arboleda {

class DeviceWorld final : public DeviceHardware {
public:
    explicit DeviceWorld(const Device& device);

    void advance(uint64_t now_us, bool working);  // what was moved arrives; what was halted does not
    uint64_t next_us() const;
    void put(uint8_t input, bool on);           // a hand holds it so
    void set_counts(uint8_t analog, uint16_t counts) { counts_[analog] = counts; }

    bool stuck = false;  // nothing follows

    bool level(uint8_t input) override { return levels_[input]; }
    uint16_t counts(uint8_t analog) override { return counts_[analog]; }
    void set_level(uint8_t output, bool high) override { outputs_[output] = high; }
    void pulse(uint8_t servo, uint16_t us) override { pulses_[servo] = us; }
    void begun(const Order& order) override;

    bool output(uint8_t at) const { return outputs_[at]; }
    uint16_t pulse_us(uint8_t at) const { return pulses_[at]; }

private:
    struct Effort {
        Order order;
        uint64_t due_us = 0;
    };

    const VerbSpec& verb(const Order& order) const { return device_.verbs[order.verb]; }
    void follow(const Order& order);
    void show(const Reading& reading, double value);

    const Device& device_;
    bool levels_[kMostInputs] = {};
    uint16_t counts_[kMostAnalogs] = {};
    bool outputs_[kMostOutputs] = {};
    uint16_t pulses_[kMostServos] = {};
    Effort efforts_[kMostDeeds];
    uint8_t efforts_count_ = 0;
    uint64_t now_us_ = 0;
};

}  // namespace arboleda
