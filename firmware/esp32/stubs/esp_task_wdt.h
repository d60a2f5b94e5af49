// What the port uses of ESP-IDF 4.4, for a syntax check only.
#pragma once

#include <stdint.h>

#include "freertos/task.h"

using esp_err_t = int;

esp_err_t esp_task_wdt_init(uint32_t seconds, bool panic);
esp_err_t esp_task_wdt_add(TaskHandle_t task);
esp_err_t esp_task_wdt_reset();
