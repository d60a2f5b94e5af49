// The board of the valve of examples/own_board behind a C interface: runs a script of timed events, says what it
// published and when. No input looks at anything: what its virtual board does, it has to do.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/device_board.h"
#include "valve_config.h"

namespace {

using namespace arboleda;

class NoHardware final : public DeviceHardware {
public:
    bool level(uint8_t) override { return false; }
    uint16_t counts(uint8_t) override { return 0; }
    void set_level(uint8_t, bool) override {}
    void pulse(uint8_t, uint16_t) override {}
    void begun(const Order&) override {}
};

class Script final : public DeviceVoice {
public:
    Script(char* out, size_t capacity) : out_(out), capacity_(capacity) {}

    void line(const char* text);
    size_t size() const { return size_; }

    void present() override { say("P", "1"); }
    void tell(const DeviceTelemetry& said) override;

private:
    void event(const char* what, const char* rest);
    void message(const char* rest);
    void run_until(uint64_t until_us);
    void say(const char* kind, const char* payload);

    char* out_;
    size_t capacity_;
    size_t size_ = 0;
    uint64_t now_us_ = 0;
    NoHardware hardware_;
    DeviceBoard board_{kDevice, hardware_, *this};
};

void Script::say(const char* kind, const char* payload) {
    const int wrote = snprintf(out_ + size_, capacity_ - size_, "%llu %s %s\n",
                               static_cast<unsigned long long>(now_us_), kind, payload);
    size_ += static_cast<size_t>(wrote);
    size_ = size_ < capacity_ ? size_ : capacity_;
}

void Script::tell(const DeviceTelemetry& said) {
    char payload[kMessageBytes + 1];
    payload[encode(kDevice, said, payload, kMessageBytes)] = '\0';
    say("S", payload);
}

void Script::run_until(uint64_t until_us) {
    while (board_.next_us() <= until_us) {
        now_us_ = board_.next_us() > now_us_ ? board_.next_us() : now_us_;
        board_.poll(now_us_);
    }
    now_us_ = until_us;
    board_.poll(now_us_);
}

void Script::line(const char* text) {
    unsigned long long at_us = 0;
    char what[16] = "";
    int rest = 0;
    if (sscanf(text, "%llu %15s %n", &at_us, what, &rest) < 2) {
        return;
    }
    if (strcmp(what, "boot") == 0) {
        now_us_ = at_us;
        board_.boot(now_us_, static_cast<uint32_t>(strtoul(text + rest, nullptr, 10)));
        return;
    }
    run_until(at_us);
    event(what, text + rest);
    run_until(at_us);
}

void Script::event(const char* what, const char* rest) {
    if (strcmp(what, "message") == 0) {
        message(rest);
    } else if (strcmp(what, "connect") == 0) {
        board_.connect(now_us_, rest[0] != '0');
    } else if (strcmp(what, "reboot") == 0) {
        board_.boot(now_us_, static_cast<uint32_t>(strtoul(rest, nullptr, 10)));
    } else if (strcmp(what, "fail") == 0) {
        board_.fail(now_us_);
    } else if (strcmp(what, "repair") == 0) {
        board_.repair(now_us_);
    }
}

// `CHANNEL RETAINED HEX`: 0 orden, 1 paro, 2 latido.
void Script::message(const char* rest) {
    unsigned channel = 0;
    unsigned retained = 0;
    int hex = 0;
    sscanf(rest, "%u %u %n", &channel, &retained, &hex);
    uint8_t bytes[2 * kMessageBytes];
    size_t size = 0;
    unsigned byte = 0;
    for (const char* at = rest + hex; size < sizeof bytes && sscanf(at, "%2x", &byte) == 1; at += 2) {
        bytes[size++] = static_cast<uint8_t>(byte);
    }
    if (channel == 0) {
        board_.receive(now_us_, decode_order(kDevice, bytes, size, retained != 0));
    } else {
        const Channel topic = channel == 1 ? Channel::kStop : Channel::kBeat;
        board_.receive(now_us_, decode(topic, bytes, size, retained != 0, 0));
    }
}

}  // namespace

extern "C" {

// Runs the lines of a zero-terminated script; the length of what was said.
size_t arboleda_device_run(const char* script, char* out, size_t capacity) {
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

// What `decode_order` makes of these bytes; one struct of C for ctypes.
struct DecodedOrder {
    int well_formed;
    int known;
    int has_seq;
    int has_epoch;
    int has_heard;
    uint32_t seq;
    uint32_t epoch;
    uint32_t heard;
    int verb;
    double value;
};

void arboleda_decode_order(const uint8_t* bytes, size_t size, DecodedOrder* out) {
    const Order order = decode_order(kDevice, bytes, size, false);
    const Message& head = order.head;
    *out = {head.well_formed, order.known,      head.seq.known,   head.epoch.known, head.heard.known,
            head.seq.value,   head.epoch.value, head.heard.value, order.verb,       order.values[0]};
}
}
