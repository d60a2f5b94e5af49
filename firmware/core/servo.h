// A servo's way to its target: the pulse goes there no faster than the servo can.
#pragma once

#include <stdint.h>

#include "device.h"
#include "device_hardware.h"
#include "due.h"

namespace arboleda {

constexpr uint64_t kServoFrameUs = 20000;  // servos look at their pulse 50 times a second

class Servo {
public:
    void reset() { *this = Servo(); }
    void start(uint64_t now_us, double target_deg, const ServoWiring& wiring);
    // Where it is. One whose place was never known cannot be held there: it is made slack.
    void stop();
    void poll(uint64_t now_us, uint8_t index, const ServoWiring& wiring, DeviceHardware& hardware);

    bool moving() const { return moving_; }
    uint64_t next_us() const { return changed_ ? 0 : moving_ ? frame_us_ + kServoFrameUs : kNever; }
    double degrees() const { return at_deg_; }

private:
    double at_deg_ = 0.0;
    double target_deg_ = 0.0;
    uint64_t frame_us_ = 0;
    uint64_t arrival_us_ = 0;  // of the first way, from a place that nobody knows
    bool known_ = false;       // where it is
    bool moving_ = false;
    bool slack_ = true;
    bool changed_ = false;
};

}  // namespace arboleda
