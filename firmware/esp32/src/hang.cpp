#include "hang.h"

#include <esp_system.h>
#include <esp_timer.h>
#include <stdint.h>

namespace arboleda {

namespace {

constexpr uint32_t kHangUs = 1000000;
constexpr uint64_t kLookUs = 100000;

uint32_t turned_us = 0;

uint32_t now_us() { return static_cast<uint32_t>(esp_timer_get_time()); }

// The turn is read before the clock, because the task may turn in between: a turn is never later than what the clock says.
void look(void*) {
    const uint32_t last_us = __atomic_load_n(&turned_us, __ATOMIC_ACQUIRE);
    if (now_us() - last_us > kHangUs) {
        esp_system_abort("the task on core 1 hangs");
    }
}

}  // namespace

// By a timer on core 0, and not by ESP-IDF's task watchdog: that has one limit for all its tasks. Its 5 s are too long for
// outputs to stay as they are, and 1 s for all would reset a processor whose Wi-Fi keeps core 0 busy for so long.
void watch_for_hangs() {
    turned();
    esp_timer_create_args_t wanted = {};
    wanted.callback = look;
    wanted.name = "hang";
    esp_timer_handle_t timer = nullptr;
    if (esp_timer_create(&wanted, &timer) != ESP_OK || esp_timer_start_periodic(timer, kLookUs) != ESP_OK) {
        esp_system_abort("no watch over the task on core 1");
    }
}

void turned() { __atomic_store_n(&turned_us, now_us(), __ATOMIC_RELEASE); }

}  // namespace arboleda
