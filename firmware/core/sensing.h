// Inputs as they count: debounced, analog values smoothed and scaled, and what facts follow from them.
#pragma once

#include <stdint.h>

#include "debounced.h"
#include "device.h"
#include "device_hardware.h"
#include "due.h"

namespace arboleda {

constexpr uint64_t kSampleUs = 2000;
constexpr uint64_t kDoubtUs = 200000;  // inputs that contradict each other so long are a fault

class Sensing {
public:
    Sensing(const Device& device, DeviceHardware& hardware);

    void begin(uint64_t now_us);  // take everything as it is
    bool poll(uint64_t now_us);   // false: it was not time to look
    uint64_t next_us() const { return looks() ? sampled_us_ + kSampleUs : kNever; }

    bool on(uint8_t input) const { return inputs_[input].on(); }
    double value(uint8_t analog) const;  // rounded to its step
    bool sane() const { return sane_; }

    // The value of the row that fits; false where none does, or several, which contradict each other.
    bool read(const Reading& reading, double* value) const;

private:
    bool looks() const { return device_.inputs.count > 0 || device_.analogs.count > 0; }
    bool sample(uint8_t input) const;
    bool plausible() const;
    bool fits(const Row& row) const;

    const Device& device_;
    DeviceHardware& hardware_;
    Debounced inputs_[kMostInputs];
    double counts_[kMostAnalogs] = {};
    uint64_t sampled_us_ = 0;
    uint64_t sane_us_ = 0;  // when everything fitted together last
    bool sane_ = true;
};

}  // namespace arboleda
