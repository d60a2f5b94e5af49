// The port's watch over its task on core 1, with a timer and a clock of ours.
#include <esp_system.h>
#include <esp_timer.h>

#include "../esp32/src/hang.h"
#include "check.h"

namespace {

int64_t clock_us = 0;
int aborts = 0;
void (*look)(void*) = nullptr;
uint64_t look_each_us = 0;
bool timers = true;  // there is memory for one

}  // namespace

int64_t esp_timer_get_time() { return clock_us; }

esp_err_t esp_timer_create(const esp_timer_create_args_t* wanted, esp_timer_handle_t*) {
    look = wanted->callback;
    return timers ? ESP_OK : 0x101;
}

esp_err_t esp_timer_start_periodic(esp_timer_handle_t, uint64_t period_us) {
    look_each_us = period_us;
    return ESP_OK;
}

void esp_system_abort(const char*) { ++aborts; }

namespace arboleda {

namespace {

// The clock goes on for so long, and the timer looks.
void pass(int64_t duration_us) {
    for (const int64_t end_us = clock_us + duration_us; clock_us < end_us;) {
        clock_us += static_cast<int64_t>(look_each_us);
        look(nullptr);
    }
}

}  // namespace

TEST(a_task_that_hangs_for_a_second_resets_the_processor_and_one_that_turns_does_not) {
    const int64_t starts_us[] = {0, (int64_t{1} << 32) - 500000};  // the other one: where 32 bits of it begin anew
    for (const int64_t start_us : starts_us) {
        clock_us = start_us;
        aborts = 0;
        watch_for_hangs();
        for (int turns = 0; turns < 5; ++turns) {
            pass(900000);
            turned();
        }
        CHECK(aborts == 0);
        pass(1100000);
        CHECK(aborts == 1);
    }
}

TEST(a_board_without_its_watch_does_not_run) {
    aborts = 0;
    timers = false;
    watch_for_hangs();
    timers = true;
    CHECK(aborts == 1);
}

}  // namespace arboleda
