// What the port uses of ESP-IDF 4.4, for a syntax check and the test of its watch.
#pragma once

#include <stdint.h>

#include "esp_err.h"

using esp_timer_handle_t = struct esp_timer*;

struct esp_timer_create_args_t {
    void (*callback)(void* argument);
    void* arg;
    int dispatch_method;
    const char* name;
    bool skip_unhandled_events;
};

esp_err_t esp_timer_create(const esp_timer_create_args_t* wanted, esp_timer_handle_t* timer);
esp_err_t esp_timer_start_periodic(esp_timer_handle_t timer, uint64_t period_us);
int64_t esp_timer_get_time();
