// The board of the valve of examples/own_board behind a C interface: runs a script of timed events, says what it
// published and when. No input looks at anything: what its virtual board does, it has to do.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/device_board.h"
#include "script.h"
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
    Script(char* out, size_t capacity) : transcript_(out, capacity) {}

    void line(const char* text);
    size_t size() const { return transcript_.size(); }

    void present() override { say("P", "1"); }
    void tell(const DeviceTelemetry& said) override;

private:
    void event(const char* what, const char* rest);
    void message(const char* rest);
    void say(const char* kind, const char* payload) { transcript_.say(now_us_, kind, payload); }

    Transcript transcript_;
    uint64_t now_us_ = 0;
    NoHardware hardware_;
    DeviceBoard board_{kDevice, hardware_, *this};
};

void Script::tell(const DeviceTelemetry& said) {
    char payload[kMessageBytes + 1];
    payload[encode(kDevice, said, payload, kMessageBytes)] = '\0';
    say("S", payload);
}

void Script::line(const char* text) {
    unsigned long long at_us = 0;
    char what[16] = "";
    int rest = 0;
    unsigned boot_id = 0;
    if (sscanf(text, "boot %llu %u", &at_us, &boot_id) == 2) {
        now_us_ = at_us;
        board_.boot(now_us_, boot_id);
        return;
    }
    if (sscanf(text, "%llu %15s %n", &at_us, what, &rest) < 2) {
        return;
    }
    run_until(board_, at_us, &now_us_);
    event(what, text + rest);
    run_until(board_, at_us, &now_us_);
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

// 0 orden, 1 paro, 2 latido.
void Script::message(const char* rest) {
    const Delivered sent(rest);
    const bool retained = sent.retained != 0;
    if (sent.channel == 0) {
        board_.receive(now_us_, decode_order(kDevice, sent.bytes, sent.size, retained));
    } else {
        const Channel topic = sent.channel == 1 ? Channel::kStop : Channel::kBeat;
        board_.receive(now_us_, decode(topic, sent.bytes, sent.size, retained, 0));
    }
}

}  // namespace

extern "C" {

// Runs the lines of a zero-terminated script; the length of what was said.
size_t arboleda_device_run(const char* script, char* out, size_t capacity) {
    return run_script<Script>(script, out, capacity);
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
    char token[kTokenBytes + 1];
};

void arboleda_decode_order(const uint8_t* bytes, size_t size, DecodedOrder* out) {
    const Order order = decode_order(kDevice, bytes, size, false);
    const Message& head = order.head;
    *out = {head.well_formed, order.known,      head.seq.known,   head.epoch.known, head.heard.known,
            head.seq.value,   head.epoch.value, head.heard.value, order.verb,       order.values[0],  {}};
    memcpy(out->token, head.token.text, sizeof out->token);
}
}
