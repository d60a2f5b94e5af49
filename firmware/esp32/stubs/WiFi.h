// What the port uses of arduino-esp32, for a syntax check only.
#pragma once

#include <Arduino.h>

enum wifi_mode_t { WIFI_STA = 1 };
enum wl_status_t { WL_CONNECTED = 3 };

struct WiFiClass {
    bool mode(wifi_mode_t mode);
    bool setSleep(bool enabled);
    bool setAutoReconnect(bool enabled);
    wl_status_t begin(const char* network, const char* password);
    wl_status_t status();
};

extern WiFiClass WiFi;
