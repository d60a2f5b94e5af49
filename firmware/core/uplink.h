// A board's way to the broker: when periodic telemetry is due, how much was told, what of it lately.
#pragma once

#include <stdint.h>

#include "due.h"
#include "freshness.h"
#include "message.h"

namespace arboleda {

constexpr uint64_t kPeriodUs = 100000;

class Uplink {
public:
    // Power came: nothing was told yet. The connection is as it was.
    void boot() {
        told_ = 0;
        freshness_ = Freshness();
    }

    void connect(bool up) { connected_ = up; }
    bool connected() const { return connected_; }

    // Telemetry is due at each tenth of a second of the clock.
    void begin(uint64_t now_us) { due_us_ = (now_us / kPeriodUs + 1) * kPeriodUs; }

    // Whether a period is over; missed ones are not made up for.
    bool over(uint64_t now_us) {
        if (!connected_ || now_us < due_us_) {
            return false;
        }
        due_us_ += kPeriodUs * ((now_us - due_us_) / kPeriodUs + 1);
        return true;
    }

    uint64_t due_us() const { return connected_ ? due_us_ : kNever; }

    // The number of the telemetry that leaves now.
    uint32_t tell(uint64_t now_us) {
        freshness_.tell(now_us, ++told_);
        return told_;
    }

    // Whether who gave it had heard the board lately, or does not say.
    bool in_time(uint64_t now_us, const Message& goal) const {
        return !goal.heard.known || freshness_.covers(now_us, goal.heard.value);
    }

private:
    Freshness freshness_;
    uint64_t due_us_ = 0;
    uint32_t told_ = 0;
    bool connected_ = false;
};

}  // namespace arboleda
