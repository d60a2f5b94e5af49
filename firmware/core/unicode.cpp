#include "unicode.h"

namespace arboleda {

namespace {

struct Form {
    uint8_t mask;
    uint8_t lead;
    uint8_t followers;
    uint32_t least;
};

constexpr Form kForms[] = {
    {0x80, 0x00, 0, 0x0}, {0xE0, 0xC0, 1, 0x80}, {0xF0, 0xE0, 2, 0x800}, {0xF8, 0xF0, 3, 0x10000}};

const Form* form_of(uint8_t lead) {
    for (const Form& form : kForms) {
        if ((lead & form.mask) == form.lead) {
            return &form;
        }
    }
    return nullptr;
}

bool surrogate(uint32_t point, uint32_t first) { return point >= first && point < first + 0x400; }

// The code point at `at`, which it moves on; false where there is none.
bool take(const uint8_t* bytes, size_t size, size_t* at, uint32_t* point) {
    const Form* form = form_of(bytes[*at]);
    if (form == nullptr || size - *at <= form->followers) {
        return false;
    }
    *point = bytes[*at] & static_cast<uint8_t>(~form->mask);
    for (int follower = 1; follower <= form->followers; ++follower) {
        const uint8_t byte = bytes[*at + static_cast<size_t>(follower)];
        if ((byte & 0xC0) != 0x80) {
            return false;
        }
        *point = *point << 6 | (byte & 0x3FU);
    }
    *at += form->followers + 1U;
    return *point >= form->least && *point <= 0x10FFFF && !surrogate(*point, 0xD800) &&
           !surrogate(*point, 0xDC00);
}

uint32_t hex(const char* four) {
    uint32_t value = 0;
    for (int at = 0; at < 4; ++at) {
        const auto c = static_cast<uint32_t>(four[at]);
        value = value << 4 | (c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
    }
    return value;
}

uint32_t named(char c) {
    constexpr char kNames[] = "bfnrt";
    constexpr char kMeant[] = "\b\f\n\r\t";
    for (int at = 0; at < 5; ++at) {
        if (kNames[at] == c) {
            return static_cast<uint32_t>(kMeant[at]);
        }
    }
    return static_cast<uint32_t>(c);
}

// One code point of a JSON string; pairs of escaped surrogates are one, lone ones stay as they are.
uint32_t decode(Text text, size_t* at) {
    uint32_t point = 0;
    if (text.at[*at] != '\\') {
        take(reinterpret_cast<const uint8_t*>(text.at), text.size, at, &point);
        return point;
    }
    if (text.at[*at + 1] != 'u') {
        *at += 2;
        return named(text.at[*at - 1]);
    }
    point = hex(text.at + *at + 2);
    *at += 6;
    const bool pair = surrogate(point, 0xD800) && text.size - *at >= 6 && text.at[*at] == '\\' &&
                      text.at[*at + 1] == 'u';
    const uint32_t low = pair ? hex(text.at + *at + 2) : 0;
    if (!surrogate(low, 0xDC00)) {
        return point;
    }
    *at += 6;
    return 0x10000 + ((point - 0xD800) << 10) + (low - 0xDC00);
}

bool within(uint32_t point, char first, char last) {
    return point >= static_cast<uint32_t>(first) && point <= static_cast<uint32_t>(last);
}

bool in_name(uint32_t point) {
    return within(point, 'A', 'Z') || within(point, 'a', 'z') || within(point, '0', '9') || point == '_' ||
           point == '.' || point == '-';
}

size_t size_in_utf8(uint32_t point) {
    size_t form = 0;
    while (form < 3 && point >= kForms[form + 1].least) {
        ++form;
    }
    return form + 1;
}

}  // namespace

bool is_utf8(const uint8_t* bytes, size_t size) {
    uint32_t point = 0;
    for (size_t at = 0; at < size;) {
        if (!take(bytes, size, &at, &point)) {
            return false;
        }
    }
    return true;
}

bool consists_of(Text text, size_t longest, bool (*is_one)(uint32_t)) {
    size_t bytes = 0;
    for (size_t at = 0; at < text.size;) {
        const uint32_t point = decode(text, &at);
        bytes += size_in_utf8(point);
        if (bytes > longest || !is_one(point)) {
            return false;
        }
    }
    return true;
}

bool is_name(Text text, size_t longest) { return text.size > 0 && consists_of(text, longest, in_name); }

void copy_ascii(Text text, char* out) {
    for (size_t at = 0; at < text.size;) {
        *out++ = static_cast<char>(decode(text, &at));
    }
    *out = '\0';
}

bool same_text(Text one, Text other) {
    size_t here = 0;
    size_t there = 0;
    while (here < one.size && there < other.size) {
        if (decode(one, &here) != decode(other, &there)) {
            return false;
        }
    }
    return here == one.size && there == other.size;
}

}  // namespace arboleda
