// Whether a command comes in time: who gave it must have heard the board lately, wherever it waited since.
#pragma once

#include <stdint.h>

namespace arboleda {

constexpr uint64_t kFreshUs = 2000000;
constexpr uint64_t kMarkUs = 250000;  // how exactly a board remembers what it told when
constexpr uint8_t kMarks = kFreshUs / kMarkUs;

// What a board has told within kFreshUs, as marks of (time, number of the telemetry) some kMarkUs apart. A number
// that it told longer ago, or has not told since its boot, is that of a command which waited.
class Freshness {
public:
    void tell(uint64_t now_us, uint32_t number);  // telemetry of this number leaves
    bool covers(uint64_t now_us, uint32_t number) const;  // whether telemetry of this number left lately

private:
    struct Mark {
        uint64_t at_us = 0;
        uint32_t number = 0;
    };

    Mark marks_[kMarks];  // the oldest first
    uint8_t count_ = 0;
    uint32_t told_ = 0;
};

}  // namespace arboleda
