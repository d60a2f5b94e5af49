#include "axes.h"

namespace arboleda {

Axes::Axes(const Config& config, Hardware& hardware) : config_(config), hardware_(hardware) { reset(); }

void Axes::reset() {
    for (uint8_t axis = 0; axis < count(); ++axis) {
        steppers_[axis] = Stepper();
        steppers_[axis].set_max_speed(config_.robot->joints[axis].max_speed_steps_s);
        steppers_[axis].set_acceleration(config_.robot->joints[axis].acceleration_steps_s2);
    }
    waiting_ = false;
    due_us_ = kNever;
    moving_ = false;
    hardware_.moving(false);
}

void Axes::start(uint64_t now_us, const int32_t* targets) {
    if (!moving_ || now_us >= retarget_at_us()) {
        head_for(now_us, targets);
        return;
    }
    waiting_ = true;
    for (uint8_t axis = 0; axis < count(); ++axis) {
        waiting_targets_[axis] = targets[axis];
    }
}

void Axes::home(uint64_t now_us) {
    constexpr int32_t kReference[kMostAxes] = {};
    for (uint8_t axis = 0; axis < count(); ++axis) {
        steppers_[axis].shift(hardware_.true_steps(axis) - steppers_[axis].position());
    }
    head_for(now_us, kReference);
}

void Axes::stop(uint64_t now_us) {
    for (uint8_t axis = 0; axis < count(); ++axis) {
        steppers_[axis].stop();
    }
    targeted_us_ = now_us;
    begin(now_us);
}

void Axes::freeze() {
    waiting_ = false;
    for (uint8_t axis = 0; axis < count(); ++axis) {
        steppers_[axis].set_current_position(steppers_[axis].position());
    }
    rest();
}

void Axes::begin(uint64_t now_us) {
    waiting_ = false;
    rest_from_us_ = now_us + 1;
    due_us_ = next_step_us(now_us);
    if (!moving_) {
        moving_ = true;
        hardware_.moving(true);
    }
}

void Axes::poll(uint64_t now_us) {
    if (!moving_) {
        return;
    }
    for (uint8_t axis = 0; axis < count(); ++axis) {
        if (steppers_[axis].wait_us(static_cast<uint32_t>(now_us)) == 0 && !steppers_[axis].still()) {
            hardware_.step(axis, steppers_[axis].clockwise());
            steppers_[axis].run(static_cast<uint32_t>(now_us));
        }
    }
    if (waiting_ && (now_us >= retarget_at_us() || still())) {
        head_for(now_us, waiting_targets_);
    }
    due_us_ = next_step_us(now_us);
}

bool Axes::arrived(uint64_t now_us) const {
    return moving_ && !waiting_ && still() && now_us >= rest_from_us_;
}

void Axes::rest() {
    due_us_ = kNever;
    if (moving_) {
        moving_ = false;
        hardware_.moving(false);
    }
}

bool Axes::stalled(uint64_t now_us) const {
    if (config_.stall_us == 0 || due_us_ == kNever || now_us < due_us_ + config_.stall_us) {
        return false;
    }
    for (uint8_t axis = 0; axis < count(); ++axis) {
        if (steppers_[axis].ramped()) {
            return true;
        }
    }
    return false;
}

uint64_t Axes::next_us(uint64_t now_us) const {
    if (!moving_) {
        return kNever;
    }
    if (still()) {
        return rest_from_us_;
    }
    const uint64_t step_us = next_step_us(now_us);
    return waiting_ ? earlier(step_us, retarget_at_us()) : step_us;
}

double Axes::degrees(uint8_t axis) const {
    return static_cast<double>(steppers_[axis].position()) * config_.robot->joints[axis].step_deg;
}

void Axes::head_for(uint64_t now_us, const int32_t* targets) {
    for (uint8_t axis = 0; axis < count(); ++axis) {
        steppers_[axis].move_to(targets[axis]);
    }
    targeted_us_ = now_us;
    begin(now_us);
}

bool Axes::still() const {
    for (uint8_t axis = 0; axis < count(); ++axis) {
        if (!steppers_[axis].still()) {
            return false;
        }
    }
    return true;
}

uint64_t Axes::next_step_us(uint64_t now_us) const {
    uint64_t next = kNever;
    for (uint8_t axis = 0; axis < count(); ++axis) {
        if (!steppers_[axis].still()) {
            next = earlier(next, now_us + steppers_[axis].wait_us(static_cast<uint32_t>(now_us)));
        }
    }
    return next;
}

uint64_t Axes::retarget_at_us() const { return targeted_us_ + config_.retarget_us; }

}  // namespace arboleda
