// The command line of the board for Linux.
#pragma once

#include "../core/config.h"
#include "world.h"

namespace arboleda {

struct Options {
    const char* robot = nullptr;
    char host[256] = "127.0.0.1";
    int port = 1883;
    Level level = Level::kIds;
    bool assume_homed = false;  // after a reboot; at the start the arm stands where `at` says
    bool until_eof = false;     // end with the standard input
    double at_deg[kMostAxes] = {};
    double places_deg[kMostPlaces][kMostAxes] = {};
    int places = 0;
};

// Of one option each; false: a sentence was said on standard error.
bool good_name(const char* name);
bool read_broker(const char* text, Options* options);
bool refuse(const char* what, const char* value, const char* allowed);

// False: a sentence was said on standard error, or the help on standard output.
bool read_options(int count, char** words, Options* options, int* status);

}  // namespace arboleda
