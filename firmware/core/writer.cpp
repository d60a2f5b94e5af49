#include "writer.h"

#include "decimal.h"

namespace arboleda {

Writer::Writer(char* buffer, size_t capacity) : buffer_(buffer), capacity_(capacity) { put('{'); }

void Writer::integer(const char* key, uint32_t value) {
    name(key);
    digits(value);
}

void Writer::angle(const char* key, double degrees) {
    const uint64_t units = ten_thousandths(degrees);
    name(key);
    if (degrees < 0.0 && units != 0) {
        put('-');
    }
    digits(units / 10000);
    put('.');
    auto rest = static_cast<uint32_t>(units % 10000);
    do {
        put(static_cast<char>('0' + rest / 1000));
        rest = rest % 1000 * 10;
    } while (rest != 0);
}

void Writer::word(const char* key, const char* value) {
    name(key);
    put('"');
    text(value);
    put('"');
}

void Writer::boolean(const char* key, bool value) {
    name(key);
    text(value ? "true" : "false");
}

void Writer::whole(const char* key, double value) {
    name(key);
    if (value < 0.0) {
        put('-');
    }
    digits(static_cast<uint64_t>(value < 0.0 ? -value : value));
}

void Writer::open(const char* key, char bracket) {
    name(key);
    put(bracket);
    first_ = true;
}

void Writer::close(char bracket) {
    put(bracket);
    first_ = false;
}

void Writer::pair(uint32_t number, const char* word) {
    next();
    put('[');
    digits(number);
    text(",\"");
    text(word);
    text("\"]");
}

size_t Writer::finish() {
    put('}');
    return size_ <= capacity_ ? size_ : 0;
}

void Writer::next() {
    if (!first_) {
        put(',');
    }
    first_ = false;
}

void Writer::name(const char* key) {
    next();
    put('"');
    text(key);
    text("\":");
}

void Writer::digits(uint64_t value) {
    char reversed[20];
    int count = 0;
    do {
        reversed[count++] = static_cast<char>('0' + value % 10);
        value /= 10;
    } while (value != 0);
    while (count > 0) {
        put(reversed[--count]);
    }
}

void Writer::text(const char* piece) {
    for (; *piece != '\0'; ++piece) {
        put(*piece);
    }
}

void Writer::put(char c) {
    if (size_ < capacity_) {
        buffer_[size_] = c;
    }
    ++size_;
}

}  // namespace arboleda
