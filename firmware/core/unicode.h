// UTF-8, and the code points that a JSON string stands for.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "text.h"

namespace arboleda {

bool is_utf8(const uint8_t* bytes, size_t size);  // shortest forms only, no surrogates

// Whether two JSON strings, well-formed and without quotes, stand for the same text.
bool same_text(Text one, Text other);

}  // namespace arboleda
