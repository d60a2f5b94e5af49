#include "servo.h"

namespace arboleda {

namespace {

constexpr double kUsPerS = 1e6;

uint16_t pulse_us(double degrees, const ServoWiring& wiring) {
    const double part = (degrees - wiring.least_deg) / (wiring.most_deg - wiring.least_deg);
    const double us = wiring.least_us + part * (static_cast<double>(wiring.most_us) - wiring.least_us);
    return static_cast<uint16_t>(us + 0.5);
}

double clamped(double degrees, const ServoWiring& wiring) {
    return degrees < wiring.least_deg ? wiring.least_deg : degrees > wiring.most_deg ? wiring.most_deg : degrees;
}

}  // namespace

void Servo::start(uint64_t now_us, double target_deg, const ServoWiring& wiring) {
    target_deg_ = clamped(target_deg, wiring);
    slack_ = false;
    moving_ = changed_ = true;
    frame_us_ = now_us;
    if (!known_) {
        // A servo goes to its first pulse as fast as it can, from wherever it is: wait for the longest way.
        at_deg_ = target_deg_;
        arrival_us_ = now_us + static_cast<uint64_t>((wiring.most_deg - wiring.least_deg) / wiring.deg_s * kUsPerS);
    }
}

void Servo::stop() {
    if (!moving_) {
        return;
    }
    moving_ = false;
    changed_ = true;
    slack_ = !known_;
    target_deg_ = at_deg_;
}

void Servo::poll(uint64_t now_us, uint8_t index, const ServoWiring& wiring, DeviceHardware& hardware) {
    if (now_us < next_us()) {
        return;
    }
    if (moving_ && known_) {
        const double way = wiring.deg_s * static_cast<double>(now_us - frame_us_) / kUsPerS;
        const double rest = target_deg_ - at_deg_;
        const bool there = (rest < 0.0 ? -rest : rest) <= way;
        at_deg_ = there ? target_deg_ : at_deg_ + (rest < 0.0 ? -way : way);
        moving_ = !there;
    } else if (moving_ && arrival_us_ <= now_us) {
        known_ = true;
        moving_ = false;
    }
    frame_us_ = now_us;
    changed_ = false;
    hardware.pulse(index, slack_ ? 0 : pulse_us(at_deg_, wiring));
}

}  // namespace arboleda
