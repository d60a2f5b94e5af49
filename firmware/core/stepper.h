// One stepper axis: the constant-acceleration ramp of D. Austin (2005), exact to the microsecond.
#pragma once

#include <stdint.h>

namespace arboleda {

// Lengths in motor steps, times in microseconds of a clock that wraps at 2^32. The numbers of the ramp are
// IEEE binary32, computed in double and rounded once when stored; build with -ffp-contract=off.
class Stepper {
public:
    Stepper();

    void set_acceleration(float steps_s2);  // its magnitude counts; 0, NaN and infinity are ignored
    void set_max_speed(float steps_s);      // as above
    void move_to(int32_t target);
    void stop();  // heads for the nearest position that the deceleration allows
    void set_current_position(int32_t position);  // stands still here and calls it `position`
    void shift(int32_t steps);  // other numbers for where it is and where it heads; the move goes on
    bool run(uint32_t now_us);  // takes one step if one is due; whether it did

    int32_t position() const { return position_; }
    int32_t target() const { return target_; }
    bool still() const { return interval_us_ == 0; }
    bool clockwise() const { return clockwise_; }  // the direction of the last step, or of the next
    bool ramped() const { return !still() && cn_ < c0_; }  // faster than a motor starts from rest
    uint32_t wait_us(uint32_t now_us) const;  // until the next step, 0 if it is due; only while not still

private:
    int32_t stopping_distance() const;
    void aim(int32_t distance, int32_t stopping);
    void compute();

    int32_t position_ = 0;
    int32_t target_ = 0;
    int32_t ramp_ = 0;  // number of the next step in the ramp: > 0 speeding up, < 0 slowing down
    uint32_t interval_us_ = 0;
    uint32_t last_step_us_ = 0;
    float speed_ = 0.0F;  // steps/s, with a sign
    float max_speed_ = 0.0F;
    float acceleration_ = 0.0F;
    float c0_ = 0.0F;  // the first interval, us
    float cn_ = 0.0F;  // this one
    float cmin_ = 1.0F;
    bool clockwise_ = false;
};

}  // namespace arboleda
