// The way to the switches: seek, brake, back off, creep, drive to 0.
#pragma once

#include <stdint.h>

#include "axes.h"
#include "switches.h"

namespace arboleda {

class Homing {
public:
    enum class Result : uint8_t { kUnderWay, kDone, kFailed };

    Homing(const Config& config, const Switches& switches, Axes& axes);

    void start();
    void cancel();  // full speed again; the axes are the caller's to stop
    Result poll();  // after each poll of the axes and look at the switches
    bool active() const { return active_; }

private:
    enum class Phase : uint8_t { kWaiting, kSeek, kBrake, kBackOff, kClear, kCreep, kReturn, kDone };

    Phase advance(uint8_t axis);
    Phase seek(uint8_t axis, bool closed);
    Phase back_off(uint8_t axis, bool closed);
    Phase creep(uint8_t axis, bool closed);
    void go(uint8_t axis, float steps_s, int32_t way);
    uint8_t turn() const;
    int32_t reach(uint8_t axis) const;

    const Config& config_;
    const Switches& switches_;
    Axes& axes_;
    Phase phases_[kMostAxes] = {};
    bool active_ = false;
    bool failed_ = false;
};

}  // namespace arboleda
