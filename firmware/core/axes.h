// The axes of an arm: they start together, and are at rest when the last one is.
#pragma once

#include <stdint.h>

#include "config.h"
#include "due.h"
#include "hardware.h"
#include "stepper.h"

namespace arboleda {

class Axes {
public:
    Axes(const Config& config, Hardware& hardware);

    void reset();  // counters 0, at rest
    void start(uint64_t now_us, const int32_t* targets);  // a target that comes too soon waits
    void home(uint64_t now_us);  // HomeBy::kKnown: count from where the hardware says, drive to 0
    void stop(uint64_t now_us);
    void freeze();  // at rest at once, where it is
    void begin(uint64_t now_us);  // moving, whatever the steppers do: homing drives them

    void poll(uint64_t now_us);       // at most one step per axis
    bool arrived(uint64_t now_us) const;
    void rest();                      // after `arrived`
    bool stalled(uint64_t now_us) const;  // steps were due long ago that a motor at speed has missed

    bool moving() const { return moving_; }
    uint64_t next_us(uint64_t now_us) const;  // the next poll that does something; kNever while at rest
    double degrees(uint8_t axis) const;
    Stepper& operator[](uint8_t axis) { return steppers_[axis]; }
    const Stepper& operator[](uint8_t axis) const { return steppers_[axis]; }
    uint8_t count() const { return config_.robot->axes; }

private:
    void head_for(uint64_t now_us, const int32_t* targets);
    bool still() const;
    uint64_t next_step_us(uint64_t now_us) const;
    uint64_t retarget_at_us() const;

    const Config& config_;
    Hardware& hardware_;
    Stepper steppers_[kMostAxes];
    bool moving_ = false;
    bool waiting_ = false;  // `waiting_targets_` replace the present ones as soon as the motors can follow
    int32_t waiting_targets_[kMostAxes] = {};
    uint64_t rest_from_us_ = 0;  // even no way at all takes a moment
    uint64_t targeted_us_ = 0;
    uint64_t due_us_ = kNever;  // the next step, as the last poll saw it
};

}  // namespace arboleda
