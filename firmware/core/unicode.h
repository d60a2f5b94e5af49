// UTF-8, and the code points that a JSON string stands for.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "text.h"

namespace arboleda {

bool is_utf8(const uint8_t* bytes, size_t size);  // shortest forms only, no surrogates

// Whether a JSON string, well-formed and without quotes, has at most so many bytes in UTF-8, and all its code points are of a kind.
bool consists_of(Text text, size_t longest, bool (*is_one)(uint32_t));

// Whether two JSON strings, well-formed and without quotes, stand for the same text.
bool same_text(Text one, Text other);

}  // namespace arboleda
