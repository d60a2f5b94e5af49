// What the core asks of the machine it runs on; every call is short and never blocks.
#pragma once

#include <stdint.h>

namespace arboleda {

class Hardware {
public:
    virtual void step(uint8_t axis, bool forward) = 0;  // one pulse, now
    virtual bool at_switch(uint8_t axis) = 0;           // its homing switch is closed, as it is now
    virtual int32_t true_steps(uint8_t axis) = 0;       // asked only where homing is Homing::kKnown
    virtual void moving(bool moving) = 0;               // a motion began, or all axes came to rest
    virtual void switch_effector(bool on) = 0;
    virtual bool effector() = 0;  // the output as it is
    virtual bool piece() = 0;     // asked only where there is a sensor

protected:
    ~Hardware() = default;
};

}  // namespace arboleda
