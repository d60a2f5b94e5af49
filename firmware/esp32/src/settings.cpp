#include "settings.h"

#include <Preferences.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "profile.h"

namespace arboleda {

namespace {

constexpr char kSpace[] = "arboleda";
constexpr char kBoots[] = "boots";
constexpr const char* kWords[] = {"robot", "wifi", "wifi_pass", "broker", "user", "password"};

struct Range {
    const char* key;
    long least;
    long most;
};

constexpr Range kNumbers[] = {{"port", 1, 65535}, {"speed", 1, 100}, {"numbers", 0, 1}, {"release", 0, 1}};

void read_word(Preferences& flash, const char* key, char* word, size_t size) {
    if (flash.isKey(key)) {
        flash.getString(key, word, size);
    }
}

bool good_name(const char* name) {
    const size_t length = strlen(name);
    return length > 0 && length <= 64 &&
           strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") == length;
}

bool save_number(Preferences& flash, const Range& range, const char* value) {
    char* end = nullptr;
    const long number = strtol(value, &end, 10);
    if (end == value || *end != '\0' || number < range.least || number > range.most) {
        return false;
    }
    return flash.putUInt(range.key, static_cast<uint32_t>(number)) > 0;
}

bool save_any(Preferences& flash, const char* key, const char* value) {
    for (const Range& range : kNumbers) {
        if (strcmp(range.key, key) == 0) {
            return save_number(flash, range, value);
        }
    }
    for (const char* word : kWords) {
        if (strcmp(word, key) == 0) {
            const bool good = strlen(value) <= 64 && (strcmp(key, "robot") != 0 || good_name(value));
            return good && flash.putString(key, value) == strlen(value);
        }
    }
    return false;
}

}  // namespace

Settings load_settings() {
    Settings settings;
    snprintf(settings.robot, sizeof settings.robot, "%s", profile::kUsualName);
    Preferences flash;
    flash.begin(kSpace, true);
    read_word(flash, "robot", settings.robot, sizeof settings.robot);
    read_word(flash, "wifi", settings.wifi, sizeof settings.wifi);
    read_word(flash, "wifi_pass", settings.wifi_password, sizeof settings.wifi_password);
    read_word(flash, "broker", settings.broker, sizeof settings.broker);
    read_word(flash, "user", settings.user, sizeof settings.user);
    read_word(flash, "password", settings.password, sizeof settings.password);
    settings.port = static_cast<uint16_t>(flash.getUInt("port", settings.port));
    settings.speed_percent = static_cast<uint8_t>(flash.getUInt("speed", settings.speed_percent));
    settings.numbered = flash.getUInt("numbers", 1) != 0;
    settings.release_on_stop = flash.getUInt("release", 0) != 0;
    flash.end();
    return settings;
}

bool save_setting(const char* key, const char* value) {
    Preferences flash;
    flash.begin(kSpace, false);
    const bool saved = save_any(flash, key, value);
    flash.end();
    return saved;
}

uint32_t boots_counted() {
    Preferences flash;
    flash.begin(kSpace, true);
    const uint32_t boots = flash.getUInt(kBoots, 0);
    flash.end();
    return boots;
}

uint32_t count_boot() {
    const uint32_t boots = boots_counted() + 1;
    Preferences flash;
    flash.begin(kSpace, false);
    flash.putUInt(kBoots, boots);
    flash.end();
    return boots;
}

}  // namespace arboleda
