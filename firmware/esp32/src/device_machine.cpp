#include "device_machine.h"

#include <Arduino.h>
#include <driver/gpio.h>

#include "device_config.h"

namespace arboleda {

namespace {

constexpr uint32_t kServoHz = 50;
constexpr uint8_t kServoBits = 16;
constexpr uint32_t kFrameUs = 1000000 / kServoHz;
// Channels of the pulse generator share a timer by pairs; each servo gets a pair, so that none disturbs another.
constexpr uint8_t kChannelsApart = 2;

gpio_num_t pin(int8_t number) { return static_cast<gpio_num_t>(number); }

uint8_t channel(uint8_t servo) { return static_cast<uint8_t>(servo * kChannelsApart); }

void configure(int8_t number, gpio_mode_t mode) {
    gpio_config_t wanted = {};
    wanted.pin_bit_mask = 1ULL << number;
    wanted.mode = mode;
    gpio_config(&wanted);
}

}  // namespace

// The level first, so that the pin never shows the other one.
void make_outputs_safe() {
    for (const OutputWiring& output : kDevice.outputs) {
        gpio_set_level(pin(output.pin), output.safe_on != output.active_low ? 1 : 0);
        configure(output.pin, GPIO_MODE_INPUT_OUTPUT);
    }
}

void DeviceMachine::begin() {
    for (const InputWiring& input : kDevice.inputs) {
        if (input.pin >= 0) {
            configure(input.pin, GPIO_MODE_INPUT);
        }
    }
    for (const AnalogWiring& analog : kDevice.analogs) {
        analogSetPinAttenuation(static_cast<uint8_t>(analog.pin), ADC_11db);
    }
    for (uint8_t servo = 0; servo < kDevice.servos.count; ++servo) {
        ledcSetup(channel(servo), kServoHz, kServoBits);
        ledcAttachPin(static_cast<uint8_t>(kDevice.servos[servo].pin), channel(servo));
        ledcWrite(channel(servo), 0);
    }
}

bool DeviceMachine::level(uint8_t input) { return gpio_get_level(pin(kDevice.inputs[input].pin)) != 0; }

uint16_t DeviceMachine::counts(uint8_t analog) {
    return static_cast<uint16_t>(analogRead(static_cast<uint8_t>(kDevice.analogs[analog].pin)));
}

void DeviceMachine::set_level(uint8_t output, bool high) {
    gpio_set_level(pin(kDevice.outputs[output].pin), high ? 1 : 0);
}

void DeviceMachine::pulse(uint8_t servo, uint16_t us) {
    ledcWrite(channel(servo), (static_cast<uint32_t>(us) << kServoBits) / kFrameUs);
}

}  // namespace arboleda
