// What the port uses of arduino-esp32, for a syntax check only.
#pragma once

#include <stddef.h>
#include <stdint.h>

uint32_t millis();

struct HardwareSerial {
    void begin(unsigned long baud);
    int available();
    int read();
    size_t print(const char* text);
    size_t println(const char* text);
    size_t printf(const char* format, ...) __attribute__((format(printf, 2, 3)));
};

extern HardwareSerial Serial;

struct EspClass {
    void restart();
};

extern EspClass ESP;
