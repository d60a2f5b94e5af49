// The press of examples/press_board on a bench: its board in a simulated world, time moved by hand.
#pragma once

#include <string.h>

#include "../core/device_board.h"
#include "../esp32/src/device_config.h"
#include "../linux/device/world.h"

namespace arboleda {

class DeviceBench final : public DeviceVoice {
public:
    DeviceBench() {
        board.boot(now_us, 100);
        board.connect(now_us, true);
    }

    void present() override {}
    void tell(const DeviceTelemetry& said) override {
        last = said;
        ++told;
        moves += said.state == State::kMoving ? 1 : 0;
    }

    void run(uint64_t duration_us) {
        const uint64_t until_us = now_us + duration_us;
        while (next_us() <= until_us) {
            now_us = next_us() > now_us ? next_us() : now_us;
            step();
        }
        now_us = until_us;
        step();
    }

    void order(const char* text) {
        step();
        const auto* bytes = reinterpret_cast<const uint8_t*>(text);
        board.receive(now_us, decode_order(kDevice, bytes, strlen(text), false));
        step();
    }

    void send(Channel channel, const char* text) {
        step();
        const auto* bytes = reinterpret_cast<const uint8_t*>(text);
        board.receive(now_us, decode(channel, bytes, strlen(text), false, 0));
        step();
    }

    bool failed(uint32_t seq, const char* word) const {
        for (uint8_t at = 0; at < last.receipts.failures(); ++at) {
            const Failure& failure = last.receipts.failure(at);
            if (failure.seq == seq && strcmp(failure.word, word) == 0) {
                return true;
            }
        }
        return false;
    }

    bool done(uint32_t seq) const {
        const MaybeNumber finished = last.receipts.numbers().finished();
        return finished.known && finished.value == seq;
    }

    DeviceWorld world{kDevice};
    uint64_t now_us = 1000000;
    DeviceBoard board{kDevice, world, *this};
    DeviceTelemetry last;
    int told = 0;
    int moves = 0;

private:
    uint64_t next_us() const { return board.next_us() < world.next_us() ? board.next_us() : world.next_us(); }
    void step() {
        world.advance(now_us, board.working());
        board.poll(now_us);
    }
};

}  // namespace arboleda
