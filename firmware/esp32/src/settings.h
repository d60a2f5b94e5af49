// What a person sets over the serial console; kept in flash.
#pragma once

#include <stdint.h>

#include "config.h"

namespace arboleda {

#ifdef ARBOLEDA_TLS
constexpr uint16_t kUsualPort = 8883;
#else
constexpr uint16_t kUsualPort = 1883;
#endif

struct Settings {
    char robot[65] = "";       // its name on MQTT: the first level of every topic, and the client id
    char wifi[33] = "";
    char wifi_password[65] = "";
    char broker[65] = "";
    uint16_t port = kUsualPort;
    char user[65] = "";
    char password[65] = "";
    uint8_t speed_percent = 100;   // of the robot's speed
    bool numbered = true;          // command numbers; false: for plants that send none
    bool release_on_stop = false;  // the effector lets go on `paro` 1
};

Settings load_settings();

// Both while nothing moves: the processor stands still while it writes to its flash.
bool save_setting(const char* key, const char* value);  // false: no such key, or no such value
uint32_t count_boot();                                  // one more boot in flash; the new count

uint32_t boots_counted();

}  // namespace arboleda
