#include "machine.h"

#include <driver/gpio.h>
#include <esp_attr.h>
#include <esp_rom_sys.h>
#include <esp_system.h>

#include "board_config.h"
#include "config.h"
#include "keepsakes.h"

namespace arboleda {

namespace {

RTC_NOINIT_ATTR KeptEffector kept;  // survives every reset but the loss of power

gpio_num_t pin(int8_t number) { return static_cast<gpio_num_t>(number); }

bool is_low(int8_t number) { return number >= 0 && gpio_get_level(pin(number)) == 0; }

void configure(int8_t number, gpio_mode_t mode) {
    gpio_config_t wanted = {};
    wanted.pin_bit_mask = 1ULL << number;
    wanted.mode = mode;
    gpio_config(&wanted);
}

// The level first, so that the pin never shows the other one.
void output(int8_t number, bool high) {
    gpio_set_level(pin(number), high ? 1 : 0);
    configure(number, GPIO_MODE_INPUT_OUTPUT);
}

void input(int8_t number) {
    if (number >= 0) {
        configure(number, GPIO_MODE_INPUT);
    }
}

bool warm_reset() {
    const esp_reset_reason_t reason = esp_reset_reason();
    return reason != ESP_RST_POWERON && reason != ESP_RST_BROWNOUT && reason != ESP_RST_UNKNOWN;
}

}  // namespace

void restore_effector() {
    const bool on = warm_reset() && kept_on(kept);
    output(kEffectorPin, on);
    kept = keep(on);
}

void Machine::begin() {
    effector_ = kept_on(kept);
    for (const AxisPins& axis : kAxisPins) {
        output(axis.step, false);
        output(axis.direction, axis.reversed);
        input(axis.home_switch);
    }
    input(kPiecePin);
    input(kAlarmPin);
    output(kEnablePin, false);
}

void Machine::look(uint64_t now_us) {
    piece_.see(now_us, is_low(kPiecePin), kDebounceUs);
    alarm_.see(now_us, is_low(kAlarmPin), kDebounceUs);
}

void Machine::step(uint8_t axis, bool forward) {
    const AxisPins& pins = kAxisPins[axis];
    if (forward != forward_[axis]) {
        forward_[axis] = forward;
        gpio_set_level(pin(pins.direction), forward != pins.reversed ? 1 : 0);
        esp_rom_delay_us(kDirectionUs);
    }
    gpio_set_level(pin(pins.step), 1);
    esp_rom_delay_us(kPulseUs);
    gpio_set_level(pin(pins.step), 0);
}

bool Machine::at_switch(uint8_t axis) { return is_low(kAxisPins[axis].home_switch); }

void Machine::switch_effector(bool on) {
    effector_ = on;
    kept = keep(on);
    gpio_set_level(pin(kEffectorPin), on ? 1 : 0);
}

}  // namespace arboleda
