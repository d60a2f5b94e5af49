// What the port uses of ESP-IDF 4.4, for a syntax check only.
#pragma once

#include <stdint.h>

int64_t esp_timer_get_time();
