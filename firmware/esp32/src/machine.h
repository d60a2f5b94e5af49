// The core's hardware on an ESP32: pins, and the effector's state over a warm reset.
#pragma once

#include "debounced.h"
#include "hardware.h"
#include "message.h"

namespace arboleda {

// The first thing of all: a gripper whose pin floats lets go.
void restore_effector();

class Machine final : public Hardware {
public:
    void begin();  // after `restore_effector`
    void look(uint64_t now_us);  // in each turn, at the piece sensor and the alarm, which count debounced

    bool alarm() const { return alarm_.on(); }
    void step(uint8_t axis, bool forward) override;
    bool at_switch(uint8_t axis) override;
    int32_t true_steps(uint8_t) override { return 0; }  // nobody knows; homing is by switches
    void moving(bool) override {}  // the drivers stay energised: q3 may fall
    void switch_effector(bool on) override;
    bool effector() override { return effector_; }
    bool piece() override { return piece_.on(); }

private:
    bool forward_[kMostAxes] = {};
    Debounced piece_;
    Debounced alarm_;
    bool effector_ = false;
};

}  // namespace arboleda
