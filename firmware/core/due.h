// Times of the board's clock, in microseconds.
#pragma once

#include <stdint.h>

namespace arboleda {

constexpr uint64_t kNever = UINT64_MAX;

inline uint64_t earlier(uint64_t one, uint64_t other) { return one < other ? one : other; }

}  // namespace arboleda
