// A level that counts once it was seen, without a break, for a while.
#pragma once

#include <stdint.h>

#include "due.h"

namespace arboleda {

class Debounced {
public:
    void begin(uint64_t now_us, bool on) {
        on_ = seen_ = on;
        since_us_ = now_us;
    }

    void see(uint64_t now_us, bool on, uint32_t debounce_us) {
        if (on != seen_) {
            seen_ = on;
            since_us_ = now_us;
        }
        if (now_us - since_us_ >= debounce_us) {
            on_ = seen_;
        }
    }

    bool on() const { return on_; }
    bool seen() const { return seen_; }  // as it was the last time

    // When what was seen last counts if it stays; kNever where it does already.
    uint64_t counts_us(uint32_t debounce_us) const { return seen_ == on_ ? kNever : since_us_ + debounce_us; }

private:
    bool on_ = false;
    bool seen_ = false;
    uint64_t since_us_ = 0;
};

}  // namespace arboleda
