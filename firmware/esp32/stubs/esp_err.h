// What the port uses of ESP-IDF 4.4, for a syntax check only.
#pragma once

using esp_err_t = int;

constexpr esp_err_t ESP_OK = 0;
