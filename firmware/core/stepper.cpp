#include "stepper.h"

#include <math.h>

namespace arboleda {

namespace {

float magnitude(float value) { return value < 0.0F ? -value : value; }

bool usable(float value) { return value > 0.0F && value <= 3.4028235e38F; }

}  // namespace

Stepper::Stepper() {
    set_acceleration(1.0F);
    set_max_speed(1.0F);
}

void Stepper::set_acceleration(float steps_s2) {
    const float a = magnitude(steps_s2);
    if (!usable(a) || a == acceleration_) {
        return;
    }
    const float ratio = static_cast<float>(static_cast<double>(acceleration_) / a);
    ramp_ = static_cast<int32_t>(static_cast<float>(static_cast<double>(ramp_) * ratio));
    c0_ = static_cast<float>(0.676 * sqrt(2.0 / a) * 1e6);
    acceleration_ = a;
    compute();
}

void Stepper::set_max_speed(float steps_s) {
    const float fastest = magnitude(steps_s);
    if (!usable(fastest) || fastest == max_speed_) {
        return;
    }
    max_speed_ = fastest;
    cmin_ = static_cast<float>(1e6 / fastest);
    if (ramp_ > 0) {
        ramp_ = stopping_distance();
        compute();
    }
}

void Stepper::move_to(int32_t target) {
    if (target != target_) {
        target_ = target;
        compute();
    }
}

void Stepper::stop() {
    if (speed_ != 0.0F) {
        const int32_t way = stopping_distance() + 1;
        move_to(position_ + (speed_ > 0.0F ? way : -way));
    }
}

void Stepper::set_current_position(int32_t position) {
    position_ = target_ = position;
    ramp_ = 0;
    interval_us_ = 0;
    speed_ = 0.0F;
}

void Stepper::shift(int32_t steps) {
    position_ += steps;
    target_ += steps;
}

bool Stepper::run(uint32_t now_us) {
    if (still() || now_us - last_step_us_ < interval_us_) {
        return false;
    }
    position_ += clockwise_ ? 1 : -1;
    last_step_us_ = now_us;
    compute();
    return true;
}

uint32_t Stepper::wait_us(uint32_t now_us) const {
    const uint32_t waited = now_us - last_step_us_;
    return waited < interval_us_ ? interval_us_ - waited : 0;
}

int32_t Stepper::stopping_distance() const {
    const float square = speed_ * speed_;
    return static_cast<int32_t>(static_cast<double>(square) / (2.0 * acceleration_));
}

// Turns the ramp round where the way that is left, or its direction, asks for it.
void Stepper::aim(int32_t distance, int32_t stopping) {
    const bool towards = clockwise_ == (distance > 0);
    const int32_t way = distance < 0 ? -distance : distance;
    if (ramp_ > 0 && (stopping >= way || !towards)) {
        ramp_ = -stopping;
    } else if (ramp_ < 0 && stopping < way && towards) {
        ramp_ = -ramp_;
    }
}

void Stepper::compute() {
    const int32_t distance = target_ - position_;
    const int32_t stopping = stopping_distance();
    if (distance == 0 && stopping <= 1) {
        interval_us_ = 0;
        ramp_ = 0;
        speed_ = 0.0F;
        return;
    }
    if (distance != 0) {
        aim(distance, stopping);
    }
    if (ramp_ == 0) {
        cn_ = c0_;
        clockwise_ = distance > 0;
    } else {
        const double c = cn_;
        cn_ = static_cast<float>(c - 2.0 * c / (4.0 * ramp_ + 1.0));
        cn_ = cn_ < cmin_ ? cmin_ : cn_;
    }
    ramp_ += 1;
    interval_us_ = static_cast<uint32_t>(cn_);
    speed_ = static_cast<float>(1e6 / cn_);
    speed_ = clockwise_ ? speed_ : -speed_;
}

}  // namespace arboleda
