// Writes one JSON object into a buffer of somebody else's.
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
    void boolean(const char* key, bool value);
    void whole(const char* key, double value);  // a whole number of either sign

    void open(const char* key, char bracket);  // what follows is inside, until `close`
    void close(char bracket);
    void pair(uint32_t number, const char* word);  // of a list

    size_t finish();  // the message's length, or 0 where it does not fit; no zero byte is added

private:
    void next();
    void name(const char* key);
    void digits(uint64_t value);
    void text(const char* piece);
    void put(char c);

    bool first_ = true;  // of its object or list
    char* buffer_;
    size_t capacity_;
    size_t size_ = 0;  // also counts what did not fit
};

}  // namespace arboleda
