// A strict reader for one small JSON object: the same messages as wire/strict.py, byte for byte.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "text.h"

namespace arboleda {

enum class Kind : uint8_t { kInteger, kReal, kWord, kTrue, kFalse, kObject, kOther };

struct Value {
    Kind kind = Kind::kOther;
    Text text;  // of numbers, words and objects; words without their quotes, escapes as they came
};

// Keeps offsets into the bytes it read; they have to outlive it.
class Object {
public:
    // False for what is not UTF-8, not JSON, no object, too long, or has a key twice, at any depth.
    bool read(const uint8_t* bytes, size_t size);

    bool find(const char* key, Value* value) const;
    bool has(const char* key) const;

    size_t count() const { return count_; }  // of keys of the outermost object
    Text key(size_t at) const { return name(entries_[at]); }
    Value value(size_t at) const;

private:
    enum class Wanted : uint8_t { kValue, kFirstKey, kKey, kFirstItem, kNext, kNothing };

    // Each key of an object that is still open: 4 bytes of text at least, `{"":`.
    static constexpr size_t kKeys = kMessageBytes / 4;
    static constexpr size_t kDepth = kMessageBytes / 2;  // each level takes two brackets

    struct Entry {
        uint16_t key;
        uint16_t key_size;
        uint16_t value;
        uint16_t value_size;
        uint16_t depth;
        Kind kind;
    };

    bool step();
    bool value();
    bool word();
    bool number();
    bool literal();
    bool key();
    bool fresh(Text name) const;
    bool next();
    bool open(bool object);
    bool close(bool object);
    void keep(Kind kind, size_t begin, size_t end);
    bool escape();
    bool digits();
    void skip_blanks();

    bool in_object() const { return (objects_[(depth_ - 1) / 8] >> ((depth_ - 1) % 8) & 1) != 0; }
    char here() const { return at_ < size_ ? text_[at_] : '\0'; }
    Text name(const Entry& entry) const { return {text_ + entry.key, entry.key_size}; }

    const char* text_ = nullptr;
    size_t size_ = 0;
    size_t at_ = 0;
    size_t depth_ = 0;
    size_t count_ = 0;
    Wanted wanted_ = Wanted::kValue;
    Entry entries_[kKeys];
    uint8_t objects_[kDepth / 8];  // one bit per level: object or list
};

}  // namespace arboleda
