// The board on an ESP32: motion on core 1, everything else on core 0.
#include <Arduino.h>
#include <esp_system.h>
#include <esp_timer.h>
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>

#if __has_include(<esp_random.h>)
#include <esp_random.h>  // newer versions of ESP-IDF declare it there
#endif

#include "console.h"
#include "exchange.h"
#include "keepsakes.h"
#include "motion.h"
#include "network.h"
#include "settings.h"
#ifdef ARBOLEDA_DEVICE
#include "device_machine.h"
#else
#include "machine.h"
#endif

namespace {

using namespace arboleda;

constexpr int kCore = 0;
constexpr uint32_t kStackBytes = 6144;

Settings settings;
Exchange exchange;

// Console and boot counter; while nothing moves, because writing to flash stops both cores.
void keep_house(void*) {
    bool counted = false;
    for (;;) {
        const bool late = esp_timer_get_time() > static_cast<int64_t>(kCountBootAfterUs);
        if (late && !counted && !exchange.moving) {
            count_boot();
            counted = true;
        }
        turn_console(settings, exchange);
        vTaskDelay(20);
    }
}

}  // namespace

void setup() {
#ifdef ARBOLEDA_DEVICE
    make_outputs_safe();
#else
    restore_effector();
#endif
    Serial.begin(115200);
    settings = load_settings();
    start_motion(settings, boot_id(boots_counted(), esp_random()), &exchange);
    start_network(settings, &exchange);
    xTaskCreatePinnedToCore(keep_house, "house", kStackBytes, nullptr, 1, nullptr, kCore);
}

// Arduino's own task is on core 1, which belongs to the motors.
void loop() { vTaskDelete(nullptr); }
