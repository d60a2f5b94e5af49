// A script of timed events for a board, as its C interface takes it, and what the board published under it.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "../core/text.h"

namespace arboleda {

// What was said, a line each, in a buffer of the caller's.
class Transcript {
public:
    Transcript(char* out, size_t capacity) : out_(out), capacity_(capacity) {}

    size_t size() const { return size_; }

    void say(uint64_t at_us, const char* kind, const char* payload) {
        const int wrote = snprintf(out_ + size_, capacity_ - size_, "%llu %s %s\n",
                                   static_cast<unsigned long long>(at_us), kind, payload);
        size_ += static_cast<size_t>(wrote);
        size_ = size_ < capacity_ ? size_ : capacity_;
    }

private:
    char* out_;
    size_t capacity_;
    size_t size_ = 0;
};

// `CHANNEL RETAINED HEX`, the channel as its number.
struct Delivered {
    explicit Delivered(const char* text) {
        int hex = 0;
        sscanf(text, "%u %u %n", &channel, &retained, &hex);
        unsigned byte = 0;
        for (const char* at = text + hex; size < sizeof bytes && sscanf(at, "%2x", &byte) == 1; at += 2) {
            bytes[size++] = static_cast<uint8_t>(byte);
        }
    }

    unsigned channel = 0;
    unsigned retained = 0;
    uint8_t bytes[2 * kMessageBytes];
    size_t size = 0;
};

// Polls whenever the board wants to be polled; `now_us` follows.
template <typename AnyBoard>
void run_until(AnyBoard& board, uint64_t until_us, uint64_t* now_us) {
    while (board.next_us() <= until_us) {
        *now_us = board.next_us() > *now_us ? board.next_us() : *now_us;
        board.poll(*now_us);
    }
    *now_us = until_us;
    board.poll(until_us);
}

// Hands the lines of a zero-terminated script to `line` of `Script`; the length of what was said.
template <typename Script>
size_t run_script(const char* script, char* out, size_t capacity) {
    Script run(out, capacity);
    char line[2 * 2 * kMessageBytes + 64];
    while (*script != '\0') {
        const size_t length = strcspn(script, "\n");
        const size_t kept = length < sizeof line ? length : sizeof line - 1;
        memcpy(line, script, kept);
        line[kept] = '\0';
        run.line(line);
        script += length + (script[length] == '\n' ? 1 : 0);
    }
    return run.size();
}

}  // namespace arboleda
