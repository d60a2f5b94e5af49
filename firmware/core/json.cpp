#include "json.h"

#include <string.h>

#include "unicode.h"

namespace arboleda {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_hex(char c) { return is_digit(c) || ((c | 0x20) >= 'a' && (c | 0x20) <= 'f'); }

struct Literal {
    const char* text;
    Kind kind;
};

constexpr Literal kLiterals[] = {{"true", Kind::kTrue}, {"false", Kind::kFalse}, {"null", Kind::kOther}};

bool is_one_of(char c, const char* set) { return c != '\0' && strchr(set, c) != nullptr; }

}  // namespace

bool Object::read(const uint8_t* bytes, size_t size) {
    count_ = depth_ = at_ = 0;
    wanted_ = Wanted::kValue;
    text_ = reinterpret_cast<const char*>(bytes);
    size_ = size;
    if (size > kMessageBytes || !is_utf8(bytes, size)) {
        return false;
    }
    skip_blanks();
    if (here() != '{') {
        return false;
    }
    while (wanted_ != Wanted::kNothing) {
        if (!step()) {
            return false;
        }
        skip_blanks();
    }
    return at_ == size_;
}

bool Object::find(const char* key, Value* value) const {
    const Text wanted = {key, strlen(key)};
    for (size_t at = 0; at < count_; ++at) {
        const Entry& entry = entries_[at];
        if (same_text(name(entry), wanted)) {
            *value = this->value(at);
            return true;
        }
    }
    return false;
}

Value Object::value(size_t at) const {
    const Entry& entry = entries_[at];
    return {entry.kind, {text_ + entry.value, entry.value_size}};
}

bool Object::has(const char* key) const {
    Value value;
    return find(key, &value);
}

bool Object::step() {
    switch (wanted_) {
        case Wanted::kFirstKey:
            return here() == '}' ? close(true) : key();
        case Wanted::kFirstItem:
            return here() == ']' ? close(false) : value();
        case Wanted::kKey:
            return key();
        case Wanted::kNext:
            return next();
        default:
            return value();
    }
}

bool Object::value() {
    const size_t begin = at_;
    if (here() == '{' || here() == '[') {
        return open(here() == '{');
    }
    if (here() == '"') {
        const bool good = word();
        keep(Kind::kWord, begin + 1, at_ - 1);
        return good;
    }
    return here() == '-' || is_digit(here()) ? number() : literal();
}

bool Object::open(bool object) {
    if (depth_ == kDepth) {
        return false;
    }
    uint8_t& byte = objects_[depth_ / 8];
    const auto bit = static_cast<uint8_t>(1U << depth_ % 8);
    byte = static_cast<uint8_t>(object ? byte | bit : byte & ~bit);
    if (depth_ == 1 && object) {
        entries_[count_ - 1].value = static_cast<uint16_t>(at_);
    }
    ++depth_;
    ++at_;
    wanted_ = object ? Wanted::kFirstKey : Wanted::kFirstItem;
    return true;
}

bool Object::close(bool object) {
    if (in_object() != object) {
        return false;
    }
    while (depth_ > 1 && count_ > 0 && entries_[count_ - 1].depth == depth_) {
        --count_;
    }
    --depth_;
    ++at_;
    if (depth_ == 1 && object) {
        keep(Kind::kObject, entries_[count_ - 1].value, at_);
    }
    wanted_ = depth_ == 0 ? Wanted::kNothing : Wanted::kNext;
    return true;
}

bool Object::next() {
    if (here() == '}' || here() == ']') {
        return close(here() == '}');
    }
    wanted_ = in_object() ? Wanted::kKey : Wanted::kValue;
    const bool comma = here() == ',';
    at_ += comma ? 1 : 0;
    return comma;
}

bool Object::key() {
    const size_t begin = at_ + 1;
    if (here() != '"' || !word() || count_ == kKeys) {
        return false;
    }
    const Text name = {text_ + begin, at_ - 1 - begin};
    if (!fresh(name)) {
        return false;
    }
    const auto offset = static_cast<uint16_t>(begin);
    const auto depth = static_cast<uint16_t>(depth_);
    entries_[count_++] = {offset, static_cast<uint16_t>(name.size), offset, 0, depth, Kind::kOther};
    skip_blanks();
    wanted_ = Wanted::kValue;
    const bool colon = here() == ':';
    at_ += colon ? 1 : 0;
    return colon;
}

bool Object::fresh(Text name) const {
    for (size_t at = count_; at > 0 && entries_[at - 1].depth == depth_; --at) {
        if (same_text(this->name(entries_[at - 1]), name)) {
            return false;
        }
    }
    return true;
}

// A value was read; where it belongs to a key of the outermost object, it is kept.
void Object::keep(Kind kind, size_t begin, size_t end) {
    wanted_ = Wanted::kNext;
    if (depth_ != 1 || end < begin) {
        return;
    }
    Entry& entry = entries_[count_ - 1];
    entry.kind = kind;
    entry.value = static_cast<uint16_t>(begin);
    entry.value_size = static_cast<uint16_t>(end - begin);
}

bool Object::word() {
    for (++at_; at_ < size_; ++at_) {
        const auto c = static_cast<uint8_t>(text_[at_]);
        if (c == '"') {
            ++at_;
            return true;
        }
        if (c < 0x20 || (c == '\\' && !escape())) {
            return false;
        }
    }
    return false;
}

// Stands on the backslash; leaves on the escape's last character.
bool Object::escape() {
    ++at_;
    if (here() != 'u') {
        return is_one_of(here(), "\"\\/bfnrt");
    }
    for (int digit = 0; digit < 4; ++digit) {
        ++at_;
        if (!is_hex(here())) {
            return false;
        }
    }
    return true;
}

bool Object::digits() {
    const size_t begin = at_;
    while (is_digit(here())) {
        ++at_;
    }
    return at_ > begin;
}

bool Object::number() {
    const size_t begin = at_;
    Kind kind = Kind::kInteger;
    at_ += here() == '-' ? 1 : 0;
    if (here() == '0') {
        ++at_;
    } else if (!digits()) {
        return false;
    }
    if (here() == '.') {
        ++at_;
        kind = Kind::kReal;
        if (!digits()) {
            return false;
        }
    }
    if (is_one_of(here(), "eE")) {
        ++at_;
        kind = Kind::kReal;
        at_ += is_one_of(here(), "+-") ? 1 : 0;
        if (!digits()) {
            return false;
        }
    }
    keep(kind, begin, at_);
    return true;
}

bool Object::literal() {
    for (const Literal& known : kLiterals) {
        const size_t length = strlen(known.text);
        if (size_ - at_ >= length && memcmp(text_ + at_, known.text, length) == 0) {
            at_ += length;
            keep(known.kind, at_, at_);
            return true;
        }
    }
    return false;
}

void Object::skip_blanks() {
    while (is_one_of(here(), " \t\n\r")) {
        ++at_;
    }
}

}  // namespace arboleda
