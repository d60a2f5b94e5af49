// Decimal text <-> numbers, correctly rounded, without a C library that allocates.
#pragma once

#include <stdint.h>

#include "text.h"

namespace arboleda {

constexpr double kMaxAngleDeg = 1e6;  // far beyond any robot; also bounds what `real` has to convert

// The functions take text that is a JSON number. False: it is not within the bounds.
bool whole(Text text, uint32_t top, uint32_t* value);  // an integer within 0 to `top`; a point is no integer
bool real(Text text, double bound, double* value);     // within +-bound, at most 1e10; below 1e-30 it is 0

// |value| in units of 1e-4, rounded to nearest, ties to even; |value| at most 1e10.
uint64_t ten_thousandths(double value);

}  // namespace arboleda
