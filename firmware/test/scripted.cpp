// The core behind a C interface: runs a script of timed events, says what the board published and when.
#include <stdio.h>
#include <string.h>

#include "../core/board.h"
#include "../core/scara.h"
#include "../core/writer.h"
#include "../linux/world.h"
#include "script.h"

namespace {

using namespace arboleda;

class Script final : public Voice {
public:
    Script(char* out, size_t capacity) : transcript_(out, capacity) { config_.stall_us = 0; }

    void line(const char* text);
    size_t size() const { return transcript_.size(); }

    void present() override { say("P", "1"); }
    void tell(const Telemetry& said) override;

private:
    void set_up(const char* text);
    void event(const char* what, const char* rest);
    void message(const char* rest);
    void reboot(const char* rest);
    void probe();
    void say(const char* kind, const char* payload) { transcript_.say(now_us_, kind, payload); }

    Transcript transcript_;
    uint64_t now_us_ = 0;
    Config config_ = scara_config();
    World world_{config_};
    Board board_{config_, world_, *this};
};

void Script::tell(const Telemetry& said) {
    char payload[kMessageBytes + 1];
    payload[encode(said, payload, kMessageBytes)] = '\0';
    say("S", payload);
}

// `config LEVEL RETARGET_US HOME_BY`, `boot TIME ID`, then `at Q1 Q2 Q3` and `place Q1 Q2 Q3` in steps.
void Script::set_up(const char* text) {
    unsigned level = 0;
    unsigned home_by = 0;
    unsigned boot_id = 0;
    unsigned long long now_us = 0;
    int32_t steps[kMostAxes] = {};
    if (sscanf(text, "config %u %u %u", &level, &config_.retarget_us, &home_by) == 3) {
        config_.level = static_cast<Level>(level);
        config_.home_by = static_cast<HomeBy>(home_by);
    } else if (sscanf(text, "at %d %d %d", &steps[0], &steps[1], &steps[2]) == 3) {
        world_.put(steps);
        board_.stand_at(steps);
    } else if (sscanf(text, "place %d %d %d", &steps[0], &steps[1], &steps[2]) == 3) {
        world_.add_place(steps);
    } else if (sscanf(text, "boot %llu %u", &now_us, &boot_id) == 2) {
        now_us_ = now_us;
        board_.boot(now_us_, boot_id, true);
    }
}

void Script::line(const char* text) {
    unsigned long long at_us = 0;
    char what[16] = "";
    int rest = 0;
    if (sscanf(text, "%llu %15s %n", &at_us, what, &rest) < 2) {
        set_up(text);
        return;
    }
    run_until(board_, at_us, &now_us_);
    event(what, text + rest);
    run_until(board_, at_us, &now_us_);
}

void Script::event(const char* what, const char* rest) {
    int first = 0;
    int second = 0;
    sscanf(rest, "%d %d", &first, &second);
    if (strcmp(what, "message") == 0) {
        message(rest);
    } else if (strcmp(what, "connect") == 0) {
        board_.connect(now_us_, first != 0);
    } else if (strcmp(what, "reboot") == 0) {
        reboot(rest);
    } else if (strcmp(what, "fail") == 0) {
        board_.fail(now_us_);
    } else if (strcmp(what, "repair") == 0) {
        board_.repair(now_us_);
    } else if (strcmp(what, "slip") == 0) {
        world_.slip(static_cast<uint8_t>(first), second);
    } else if (strcmp(what, "supplied") == 0) {
        world_.supplied = first != 0;
    } else if (strcmp(what, "grips") == 0) {
        world_.grips = first != 0;
    } else if (strcmp(what, "stuck") == 0) {
        world_.stuck = first != 0;
    } else if (strcmp(what, "drop") == 0) {
        world_.drop();
    } else if (strcmp(what, "probe") == 0) {
        probe();
    }
}

void Script::message(const char* rest) {
    const Delivered sent(rest);
    const auto topic = static_cast<Channel>(sent.channel);
    board_.receive(now_us_, decode(topic, sent.bytes, sent.size, sent.retained != 0, kScara.axes));
}

void Script::reboot(const char* rest) {
    unsigned boot_id = 0;
    unsigned homed = 0;
    sscanf(rest, "%u %u", &boot_id, &homed);
    board_.poll(now_us_);
    world_.power_up();
    board_.boot(now_us_, boot_id, homed != 0);
}

void Script::probe() {
    char text[128];
    snprintf(text, sizeof text, "%d %d %d %d %d %d %u", board_.axes()[0].position(),
             board_.axes()[1].position(), board_.axes()[2].position(), world_.true_steps(0),
             world_.true_steps(1), world_.true_steps(2), board_.refusals());
    say("@", text);
}

}  // namespace

extern "C" {

// Runs the lines of a zero-terminated script; the length of what was said.
size_t arboleda_run(const char* script, char* out, size_t capacity) {
    return run_script<Script>(script, out, capacity);
}

// What `decode` makes of these bytes; one struct of C for ctypes.
struct Decoded {
    int well_formed;
    int has_seq;
    int has_epoch;
    int has_heard;
    uint32_t seq;
    uint32_t epoch;
    uint32_t heard;
    double q_deg[kMostAxes];
    int on;
    int stop;
    char token[kTokenBytes + 1];
};

void arboleda_decode(int channel, const uint8_t* bytes, size_t size, int axes, Decoded* out) {
    const Message message = decode(static_cast<Channel>(channel), bytes, size, false, static_cast<uint8_t>(axes));
    *out = {message.well_formed, message.seq.known,   message.epoch.known, message.heard.known,
            message.seq.value,   message.epoch.value, message.heard.value, {},
            message.on,          static_cast<int>(message.stop), {}};
    memcpy(out->token, message.token.text, sizeof out->token);
    memcpy(out->q_deg, message.q_deg, sizeof out->q_deg);
}

// One stepper, for comparing ramps call by call.
Stepper* arboleda_stepper() {
    static Stepper stepper;
    stepper = Stepper();
    return &stepper;
}

void arboleda_speed(Stepper* stepper, float steps_s) { stepper->set_max_speed(steps_s); }
void arboleda_acceleration(Stepper* stepper, float steps_s2) { stepper->set_acceleration(steps_s2); }
void arboleda_move(Stepper* stepper, int32_t target) { stepper->move_to(target); }
void arboleda_stop(Stepper* stepper) { stepper->stop(); }
void arboleda_here(Stepper* stepper, int32_t position) { stepper->set_current_position(position); }

// Polls at the next step, if one is due until then: when it was, or -1.
int64_t arboleda_step(Stepper* stepper, int64_t now_us, int64_t until_us) {
    const int64_t step_us = now_us + stepper->wait_us(static_cast<uint32_t>(now_us));
    const bool due = !stepper->still() && step_us <= until_us;
    return due && stepper->run(static_cast<uint32_t>(step_us)) ? step_us : -1;
}

int32_t arboleda_position(const Stepper* stepper) { return stepper->position(); }

// `{"q":...}` with this angle.
size_t arboleda_angle(double degrees, char* out, size_t capacity) {
    Writer writer(out, capacity);
    writer.angle("q", degrees);
    return writer.finish();
}
}
