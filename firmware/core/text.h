// A piece of somebody else's bytes.
#pragma once

#include <stddef.h>

namespace arboleda {

constexpr size_t kMessageBytes = 512;  // the longest message, both ways

struct Text {
    const char* at = nullptr;
    size_t size = 0;
};

}  // namespace arboleda
