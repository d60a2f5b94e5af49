// What the port uses of ESP-IDF 4.4, for a syntax check and the test of its watch.
#pragma once

#include <stdint.h>

enum esp_reset_reason_t { ESP_RST_UNKNOWN, ESP_RST_POWERON, ESP_RST_SW = 3, ESP_RST_BROWNOUT = 9 };

esp_reset_reason_t esp_reset_reason();
void esp_system_abort(const char* details);
uint32_t esp_random();
