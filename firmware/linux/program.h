// What the two programs have in common: their clock, how they are ended, lines from their standard input.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace arboleda {

constexpr uint64_t kUsPerS = 1000000;

uint64_t now_us();
void begin_program();  // chance, and the signals that end it
bool ended();          // one of them came

class Lines {
public:
    // Until something comes from another thread, is typed, or is due: a line that was typed to its end, or nullptr.
    const char* wait(int wake_fd, uint64_t due_us);
    bool over() const { return over_; }

private:
    const char* take();

    char line_[128] = "";
    size_t typed_ = 0;
    bool over_ = false;
};

}  // namespace arboleda
