// One board: its command rules, stop latch, heartbeat watch, homing and telemetry.
#pragma once

#include <stdint.h>

#include "axes.h"
#include "config.h"
#include "hardware.h"
#include "homing.h"
#include "message.h"
#include "switches.h"
#include "telemetry.h"
#include "uplink.h"
#include "watch.h"

namespace arboleda {

// Where a board's words go; called in the thread that calls the board.
class Voice {
public:
    virtual void present() = 0;  // `conexion` 1
    virtual void tell(const Telemetry& said) = 0;

protected:
    ~Voice() = default;
};

// A pure machine: time and messages in, pulses and telemetry out. It speaks as sim/board.py does.
class Board {
public:
    Board(const Config& config, Hardware& hardware, Voice& voice);

    // Power came: numbers, position and latch are gone. The effector is as the hardware has it.
    void boot(uint64_t now_us, uint32_t boot_id, bool homed);
    void stand_at(const int32_t* steps);  // a hand put the still arm there: count from it
    void connect(uint64_t now_us, bool up);  // the MQTT client reached or lost its broker
    void receive(uint64_t now_us, const Message& message);
    void poll(uint64_t now_us);  // as often as possible, and not later than `next_us`
    void fail(uint64_t now_us);    // a driver's alarm: ramp to a stop, move nothing until `repair`
    void repair(uint64_t now_us);  // the alarm is gone

    uint64_t next_us() const;  // kNever: only when something comes
    State state() const;
    const Axes& axes() const { return axes_; }
    bool homed() const { return homed_; }
    uint32_t refusals() const { return refusals_; }      // messages refused since power-up
    uint32_t lost_steps() const { return lost_steps_; }  // how often steps were lost since boot

private:
    enum class Job : uint8_t { kNone, kMove, kHome };

    void move_on();
    void check_way();
    void hear(const Message& beat);
    void obey(const Message& goal);
    void accept(const Message& goal);
    void act(const Message& goal);
    void take_up(Job job, const Message& goal);
    void move(const Message& goal);
    void home();
    Refusal refusal(const Message& goal) const;
    Refusal objection(const Message& goal) const;
    bool within_limits(const Message& goal) const;
    void stop(bool latch);
    void finish();
    void lose_steps();
    void refuse(Refusal refusal, const Message& message);
    void announce();
    void tell();
    Telemetry telemetry(uint32_t number);
    uint64_t silent_from_us() const;

    const Config& config_;
    Hardware& hardware_;
    Voice& voice_;
    Axes axes_;
    Switches switches_;
    Homing homing_;
    Uplink uplink_;
    Watch watch_;  // over its moves: ramp to a stop
    Receipts receipts_;
    Job job_ = Job::kNone;  // what counts as done when the axes come to rest
    Message job_goal_;  // the command that it is
    uint64_t now_us_ = 0;
    uint32_t boot_id_ = 0;
    uint32_t refusals_ = 0;
    uint32_t lost_steps_ = 0;
    bool homed_ = false;
    bool latched_ = false;
    bool faulted_ = false;
};

}  // namespace arboleda
