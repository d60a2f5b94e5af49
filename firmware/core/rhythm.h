// When periodic telemetry is due.
#pragma once

#include <stdint.h>

namespace arboleda {

constexpr uint64_t kPeriodUs = 100000;

class Rhythm {
public:
    // At each tenth of a second of the clock.
    void begin(uint64_t now_us) { due_us_ = (now_us / kPeriodUs + 1) * kPeriodUs; }

    // Whether a period is over; missed ones are not made up for.
    bool over(uint64_t now_us) {
        if (now_us < due_us_) {
            return false;
        }
        due_us_ += kPeriodUs * ((now_us - due_us_) / kPeriodUs + 1);
        return true;
    }

    uint64_t due_us() const { return due_us_; }

private:
    uint64_t due_us_ = 0;
};

}  // namespace arboleda
