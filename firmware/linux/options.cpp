#include "options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

namespace arboleda {

namespace {

constexpr int kBadInput = 2;

constexpr char kHelp[] =
    "board --robot NAME [--broker HOST:PORT] ...\n"
    "A SCARA's board on MQTT, with the firmware's core and an arm that is not there.\n\n"
    "  --robot NAME         its name on MQTT, e.g. ra_1\n"
    "  --broker HOST:PORT   default 127.0.0.1:1883; login from $ARBOLEDA_MQTT_USER, $ARBOLEDA_MQTT_PASSWORD\n"
    "  --at Q1,Q2,Q3        where the arm stands at the start, degrees as on MQTT; default 0,0,0\n"
    "  --place Q1,Q2,Q3     a part lies ready here for the piece sensor; up to 40 times\n"
    "  --level ids|joints   what it says; default ids\n"
    "  --assume-homed       homed after a reboot\n"
    "  --until-eof          end with the standard input\n"
    "On its standard input it takes faults; `help` lists them.\n";

constexpr option kOptions[] = {{"robot", required_argument, nullptr, 'r'},
                               {"broker", required_argument, nullptr, 'b'},
                               {"at", required_argument, nullptr, 'a'},
                               {"place", required_argument, nullptr, 'p'},
                               {"level", required_argument, nullptr, 'l'},
                               {"assume-homed", no_argument, nullptr, 'h'},
                               {"until-eof", no_argument, nullptr, 'e'},
                               {"help", no_argument, nullptr, '?'},
                               {nullptr, 0, nullptr, 0}};

bool read_pose(const char* what, const char* text, double* pose) {
    char rest = '\0';
    if (sscanf(text, "%lf,%lf,%lf%c", &pose[0], &pose[1], &pose[2], &rest) != 3) {
        return refuse(what, text, "three angles, e.g. 45,9.9,0");
    }
    return true;
}

bool read_place(const char* text, Options* options) {
    if (options->places == kMostPlaces) {
        return refuse("a further --place", text, "40 places");
    }
    return read_pose("--place", text, options->places_deg[options->places++]);
}

bool read_one(int letter, const char* value, Options* options) {
    switch (letter) {
        case 'r':
            options->robot = value;
            return good_name(value) || refuse("--robot", value, "1 to 64 of A-Z a-z 0-9 _ -");
        case 'b':
            return read_broker(value, options);
        case 'a':
            return read_pose("--at", value, options->at_deg);
        case 'p':
            return read_place(value, options);
        case 'l':
            options->level = strcmp(value, "joints") == 0 ? Level::kJoints : Level::kIds;
            return options->level == Level::kJoints || strcmp(value, "ids") == 0 ||
                   refuse("--level", value, "ids, joints");
        case 'h':
            return options->assume_homed = true;
        default:
            return options->until_eof = true;
    }
}

}  // namespace

bool refuse(const char* what, const char* value, const char* allowed) {
    fprintf(stderr, "board: %s is '%s'; allowed: %s\n", what, value, allowed);
    return false;
}

bool good_name(const char* name) {
    const size_t length = strlen(name);
    const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    return length >= 1 && length <= 64 && strspn(name, letters) == length;
}

bool read_broker(const char* text, Options* options) {
    const char* colon = strrchr(text, ':');
    const size_t length = colon == nullptr ? strlen(text) : static_cast<size_t>(colon - text);
    char* end = nullptr;
    const long port = colon == nullptr ? 1883 : strtol(colon + 1, &end, 10);
    const bool whole = colon == nullptr || (end != colon + 1 && *end == '\0');
    if (length == 0 || length >= sizeof options->host || !whole || port < 1 || port > 65535) {
        return refuse("--broker", text, "HOST:PORT, e.g. 127.0.0.1:1883");
    }
    const bool bracketed = text[0] == '[' && text[length - 1] == ']';
    memcpy(options->host, text + (bracketed ? 1 : 0), length - (bracketed ? 2 : 0));
    options->host[length - (bracketed ? 2 : 0)] = '\0';
    options->port = static_cast<int>(port);
    return true;
}

bool read_options(int count, char** words, Options* options, int* status) {
    *status = kBadInput;
    opterr = 0;
    for (int letter = 0; (letter = getopt_long(count, words, "", kOptions, nullptr)) != -1;) {
        if (letter == '?' && optopt == 0 && strcmp(words[optind - 1], "--help") == 0) {
            fputs(kHelp, stdout);
            *status = 0;
            return false;
        }
        if (letter == '?') {
            return refuse("an option", words[optind - 1], "see board --help");
        }
        if (!read_one(letter, optarg, options)) {
            return false;
        }
    }
    if (optind < count) {
        return refuse("an argument", words[optind], "none; see board --help");
    }
    if (options->robot == nullptr) {
        return refuse("--robot", "", "the robot's name on MQTT, e.g. ra_1");
    }
    return true;
}

}  // namespace arboleda
