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

size_t Writer::finish() {
    put('}');
    return size_ <= capacity_ ? size_ : 0;
}

void Writer::name(const char* key) {
    if (size_ > 1) {
        put(',');
    }
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
