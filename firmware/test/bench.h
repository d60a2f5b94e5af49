// A board on a bench: the SCARA in a simulated world, time moved by hand, everything it said kept.
#pragma once

#include <string.h>

#include "../core/board.h"
#include "../core/scara.h"
#include "../linux/world.h"

namespace arboleda {

class Bench final : public Voice {
public:
    explicit Bench(const Config& wanted = scara_config())
        : config(wanted), world(config), board(config, world, *this) {
        board.boot(now_us, 100, true);
        board.connect(now_us, true);
    }

    void present() override { ++presences; }
    void tell(const Telemetry& said) override {
        last = said;
        ++told;
    }

    void run(uint64_t duration_us) {
        const uint64_t until_us = now_us + duration_us;
        while (board.next_us() <= until_us) {
            now_us = board.next_us() > now_us ? board.next_us() : now_us;
            board.poll(now_us);
        }
        now_us = until_us;
        board.poll(now_us);
    }

    // The board's loop hangs: nobody polls, then one poll.
    void stall(uint64_t duration_us) {
        now_us += duration_us;
        board.poll(now_us);
    }

    void send(Channel channel, const char* text) {
        const auto* bytes = reinterpret_cast<const uint8_t*>(text);
        board.receive(now_us, decode(channel, bytes, strlen(text), false, config.robot->axes));
        board.poll(now_us);
    }

    Config config;
    World world;
    uint64_t now_us = 1000000;
    Board board;
    Telemetry last;
    int presences = 0;
    int told = 0;
};

}  // namespace arboleda
