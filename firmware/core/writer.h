// Writes one flat JSON object into a buffer of somebody else's.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace arboleda {

class Writer {
public:
    Writer(char* buffer, size_t capacity);

    void integer(const char* key, uint32_t value);
    void angle(const char* key, double degrees);  // with at most 4 decimals, and at least one
    void word(const char* key, const char* value);  // a word that needs no escapes

    size_t finish();  // the message's length, or 0 where it does not fit; no zero byte is added

private:
    void name(const char* key);
    void digits(uint64_t value);
    void text(const char* piece);
    void put(char c);

    char* buffer_;
    size_t capacity_;
    size_t size_ = 0;  // also counts what did not fit
};

}  // namespace arboleda
