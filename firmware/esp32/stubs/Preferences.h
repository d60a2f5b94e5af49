// What the port uses of arduino-esp32, for a syntax check only.
#pragma once

#include <Arduino.h>

struct Preferences {
    bool begin(const char* space, bool read_only);
    void end();
    bool isKey(const char* key);
    size_t getString(const char* key, char* value, size_t capacity);
    size_t putString(const char* key, const char* value);
    uint32_t getUInt(const char* key, uint32_t otherwise);
    size_t putUInt(const char* key, uint32_t value);
};
