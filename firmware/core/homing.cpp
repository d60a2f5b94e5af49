#include "homing.h"

namespace arboleda {

namespace {

constexpr int32_t kMarginSteps = 200;  // beyond the whole way of an axis, where a switch must have been met

}  // namespace

Homing::Homing(const Config& config, const Switches& switches, Axes& axes)
    : config_(config), switches_(switches), axes_(axes) {}

void Homing::start() {
    active_ = true;
    failed_ = false;
    for (Phase& phase : phases_) {
        phase = Phase::kWaiting;
    }
}

void Homing::cancel() {
    for (uint8_t axis = 0; active_ && axis < axes_.count(); ++axis) {
        axes_[axis].set_max_speed(config_.robot->joints[axis].max_speed_steps_s);
    }
    active_ = false;
}

Homing::Result Homing::poll() {
    const uint8_t now = turn();
    bool done = true;
    for (uint8_t axis = 0; axis < axes_.count() && !failed_; ++axis) {
        if (phases_[axis] != Phase::kWaiting || config_.home[axis].turn == now) {
            phases_[axis] = advance(axis);
        }
        done = done && phases_[axis] == Phase::kDone;
    }
    if (failed_ || done) {
        cancel();
    }
    return failed_ ? Result::kFailed : done ? Result::kDone : Result::kUnderWay;
}

// The lowest turn that is not done.
uint8_t Homing::turn() const {
    uint8_t lowest = UINT8_MAX;
    for (uint8_t axis = 0; axis < axes_.count(); ++axis) {
        const uint8_t turn = config_.home[axis].turn;
        lowest = phases_[axis] != Phase::kDone && turn < lowest ? turn : lowest;
    }
    return lowest;
}

Homing::Phase Homing::advance(uint8_t axis) {
    const bool closed = switches_.closed(axis);
    const HomeWay& way = config_.home[axis];
    switch (phases_[axis]) {
        case Phase::kWaiting:
            go(axis, way.seek_steps_s, way.direction * reach(axis));
            return Phase::kSeek;
        case Phase::kSeek:
            return seek(axis, closed);
        case Phase::kBrake:
            if (axes_[axis].still()) {
                go(axis, way.seek_steps_s, -way.direction * reach(axis));
                return Phase::kBackOff;
            }
            return Phase::kBrake;
        case Phase::kBackOff:
            return back_off(axis, closed);
        case Phase::kClear:
            if (axes_[axis].still()) {
                go(axis, way.creep_steps_s, way.direction * reach(axis));
                return Phase::kCreep;
            }
            return Phase::kClear;
        case Phase::kCreep:
            return creep(axis, closed);
        case Phase::kReturn:
            return axes_[axis].still() ? Phase::kDone : Phase::kReturn;
        default:
            return Phase::kDone;
    }
}

Homing::Phase Homing::seek(uint8_t axis, bool closed) {
    if (closed) {
        axes_[axis].stop();
        return Phase::kBrake;
    }
    failed_ = axes_[axis].still();  // the whole way, and no switch
    return Phase::kSeek;
}

Homing::Phase Homing::back_off(uint8_t axis, bool closed) {
    if (!closed) {
        go(axis, config_.home[axis].seek_steps_s, -config_.home[axis].direction * config_.home[axis].clear_steps);
        return Phase::kClear;
    }
    failed_ = axes_[axis].still();  // the whole way, and the switch is still closed
    return Phase::kBackOff;
}

Homing::Phase Homing::creep(uint8_t axis, bool closed) {
    if (closed) {
        axes_[axis].set_current_position(config_.home[axis].switch_steps);
        axes_[axis].set_max_speed(config_.robot->joints[axis].max_speed_steps_s);
        axes_[axis].move_to(0);
        return Phase::kReturn;
    }
    failed_ = axes_[axis].still();
    return Phase::kCreep;
}

void Homing::go(uint8_t axis, float steps_s, int32_t way) {
    axes_[axis].set_max_speed(steps_s);
    axes_[axis].move_to(axes_[axis].position() + way);
}

int32_t Homing::reach(uint8_t axis) const {
    return config_.robot->joints[axis].most_steps + kMarginSteps;
}

}  // namespace arboleda
