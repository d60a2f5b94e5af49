// What the port uses of ESP-IDF 4.4, for a syntax check only.
#pragma once

#include <stdint.h>

enum gpio_num_t { GPIO_NUM_NC = -1, GPIO_NUM_MAX = 40 };
enum gpio_mode_t { GPIO_MODE_INPUT = 1, GPIO_MODE_INPUT_OUTPUT = 3 };

int gpio_set_level(gpio_num_t pin, uint32_t level);
int gpio_get_level(gpio_num_t pin);

struct gpio_config_t {
    uint64_t pin_bit_mask;
    gpio_mode_t mode;
    int pull_up_en;
    int pull_down_en;
    int intr_type;
};

int gpio_config(const gpio_config_t* config);
