#include "console.h"

#include <Arduino.h>
#include <stdio.h>
#include <string.h>

#include "network.h"

namespace arboleda {

namespace {

constexpr char kHelp[] =
    "show              the settings, and how the board is\n"
    "set KEY VALUE     robot wifi wifi_pass broker port user password speed numbers release;\n"
    "                  it counts after a restart\n"
    "restart           only while nothing moves\n";

void show(const Settings& settings, const Exchange& exchange) {
    Serial.printf("robot %s, wifi %s (%s), broker %s:%u (%s), user %s\n", settings.robot, settings.wifi,
                  on_wifi() ? "there" : "not there", settings.broker, settings.port,
                  on_broker() ? "there" : "not there", settings.user);
    Serial.printf("speed %u %%, numbers %d, release on stop %d, moving %d, lost steps %lu, refused %lu\n",
                  settings.speed_percent, settings.numbered, settings.release_on_stop, exchange.moving,
                  static_cast<unsigned long>(exchange.lost_steps),
                  static_cast<unsigned long>(exchange.refusals));
}

void set(const char* rest, const Exchange& exchange) {
    char key[16] = "";
    int value = 0;
    if (exchange.moving) {
        Serial.println("not while it moves: writing to flash stops the motors' pulses");
    } else if (sscanf(rest, "%15s %n", key, &value) == 1 && save_setting(key, rest + value)) {
        Serial.println("kept; it counts after `restart`");
    } else {
        Serial.println("no such key, or no such value; `help` lists them");
    }
}

void obey(const char* line, const Settings& settings, const Exchange& exchange) {
    if (strcmp(line, "show") == 0) {
        show(settings, exchange);
    } else if (strncmp(line, "set ", 4) == 0) {
        set(line + 4, exchange);
    } else if (strcmp(line, "restart") == 0 && !exchange.moving) {
        ESP.restart();
    } else if (line[0] != '\0') {
        Serial.print(kHelp);
    }
}

}  // namespace

void turn_console(const Settings& settings, const Exchange& exchange) {
    static char line[96] = "";
    static size_t size = 0;
    while (Serial.available() > 0) {
        const auto c = static_cast<char>(Serial.read());
        if (c != '\n' && c != '\r') {
            size += size + 1 < sizeof line ? 1 : 0;
            line[size - 1] = c;
            continue;
        }
        line[size] = '\0';
        size = 0;
        obey(line, settings, exchange);
    }
}

}  // namespace arboleda
