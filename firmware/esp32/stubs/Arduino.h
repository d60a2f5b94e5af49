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

enum adc_attenuation_t { ADC_0db, ADC_2_5db, ADC_6db, ADC_11db };

uint16_t analogRead(uint8_t pin);
void analogSetPinAttenuation(uint8_t pin, adc_attenuation_t attenuation);
uint32_t ledcSetup(uint8_t channel, uint32_t frequency, uint8_t bits);
void ledcAttachPin(uint8_t pin, uint8_t channel);
void ledcWrite(uint8_t channel, uint32_t duty);

struct EspClass {
    void restart();
};

extern EspClass ESP;
