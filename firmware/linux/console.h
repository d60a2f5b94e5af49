// What can go wrong with a board, for a person to type.
#pragma once

#include "../core/board.h"
#include "world.h"

namespace arboleda {

// What the program itself has to do.
struct Wish {
    enum class What : uint8_t { kNothing, kQuit, kReboot, kStall, kMute } what = What::kNothing;
    uint64_t duration_us = 0;
};

// Carries out one line, or says on standard output why not.
Wish obey(const char* line, uint64_t now_us, Board* board, World* world);

}  // namespace arboleda
