// UTF-8, and the code points that a JSON string stands for.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "text.h"

namespace arboleda {

bool is_utf8(const uint8_t* bytes, size_t size);  // shortest forms only, no surrogates

// Whether a JSON string, well-formed and without quotes, has at most so many bytes in UTF-8, and all its code points are of a kind.
bool consists_of(Text text, size_t longest, bool (*is_one)(uint32_t));

// Whether it is a name: some of A-Z a-z 0-9 _ . -, and at most so many.
bool is_name(Text text, size_t longest);

// A JSON string of ASCII that fits, as text with a zero byte at its end.
void copy_ascii(Text text, char* out);

// Whether two JSON strings, well-formed and without quotes, stand for the same text.
bool same_text(Text one, Text other);

}  // namespace arboleda
