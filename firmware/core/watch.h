// Whether the plant is heard: once it has beaten, what moves without beat or command is ended.
#pragma once

#include <stdint.h>

#include "due.h"
#include "receipts.h"

namespace arboleda {

constexpr uint64_t kSilenceUs = 1000000;

class Watch {
public:
    void boot(uint64_t now_us) {
        beaten_ = false;
        alive_us_ = now_us;
    }

    void obeyed(uint64_t now_us) { alive_us_ = now_us; }

    // A beat of the newest epoch counts; it keeps alive what was begun under that epoch.
    void hear(uint64_t now_us, uint32_t epoch, const Receipts& numbers) {
        if (numbers.least().known && numbers.least().value != epoch) {
            return;
        }
        beaten_ = true;
        const bool ours = !numbers.epoch().known || numbers.epoch().value == epoch;
        alive_us_ = ours ? now_us : alive_us_;
    }

    // When the silence gets too long; kNever before the first beat.
    uint64_t silent_from_us() const { return beaten_ ? alive_us_ + kSilenceUs : kNever; }

private:
    uint64_t alive_us_ = 0;
    bool beaten_ = false;
};

}  // namespace arboleda
