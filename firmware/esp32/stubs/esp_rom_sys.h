// What the port uses of ESP-IDF 4.4, for a syntax check only.
#pragma once

#include <stdint.h>

void esp_rom_delay_us(uint32_t us);
