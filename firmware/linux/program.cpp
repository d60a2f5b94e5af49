#include "program.h"

#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

namespace arboleda {

namespace {

volatile sig_atomic_t signalled = 0;

void end(int) { signalled = 1; }

}  // namespace

uint64_t now_us() {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<uint64_t>(now.tv_sec) * kUsPerS + static_cast<uint64_t>(now.tv_nsec) / 1000;
}

void begin_program() {
    srand(static_cast<unsigned>(now_us()) ^ static_cast<unsigned>(getpid()));
    signal(SIGINT, end);
    signal(SIGTERM, end);
}

bool ended() { return signalled != 0; }

const char* Lines::wait(int wake_fd, uint64_t due_us) {
    const uint64_t now = now_us();
    const uint64_t rest_us = due_us > now + kUsPerS ? kUsPerS : due_us > now ? due_us - now : 0;
    pollfd waited[] = {{wake_fd, POLLIN, 0}, {over_ ? -1 : STDIN_FILENO, POLLIN, 0}};
    poll(waited, 2, static_cast<int>((rest_us + 999) / 1000));
    return waited[1].revents != 0 ? take() : nullptr;
}

const char* Lines::take() {
    char c = '\0';
    if (read(STDIN_FILENO, &c, 1) <= 0) {
        over_ = true;
        return nullptr;
    }
    if (c != '\n') {
        typed_ += typed_ + 1 < sizeof line_ ? 1 : 0;
        line_[typed_ - 1] = c;
        return nullptr;
    }
    line_[typed_] = '\0';
    typed_ = 0;
    return line_;
}

}  // namespace arboleda
