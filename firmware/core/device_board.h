// The board of a device of a declared kind: its order rules, stop latch, heartbeat watch, inputs and telemetry.
#pragma once

#include <stdint.h>

#include "device.h"
#include "device_hardware.h"
#include "device_telemetry.h"
#include "order.h"
#include "sensing.h"
#include "servo.h"
#include "uplink.h"
#include "watch.h"

namespace arboleda {

constexpr uint64_t kLeastGapUs = 20000;  // between two reports that only inputs are the reason for
constexpr uint8_t kMostDeeds = kMostFacts + 2;  // one work, one query, a switch for each fact

// Where a board's words go; called in the thread that calls the board.
class DeviceVoice {
public:
    virtual void present() = 0;  // `conexion` 1
    virtual void tell(const DeviceTelemetry& said) = 0;

protected:
    ~DeviceVoice() = default;
};

// A pure machine: time, messages and levels in, outputs and telemetry out. Where no input looks, it does and says
// what the virtual board of the same kind does (sim/board.py, sim/machine.py).
class DeviceBoard {
public:
    DeviceBoard(const Device& device, DeviceHardware& hardware, DeviceVoice& voice);

    void boot(uint64_t now_us, uint32_t boot_id);  // power came: outputs are safe, everything else is forgotten
    void connect(uint64_t now_us, bool up);
    void receive(uint64_t now_us, const Message& message);  // `paro`, `latido`
    void receive(uint64_t now_us, const Order& order);
    void poll(uint64_t now_us);  // as often as possible, and not later than `next_us`
    void fail(uint64_t now_us);    // an alarm: work is given up, none begins until `repair`
    void repair(uint64_t now_us);

    uint64_t next_us() const;
    State state() const;
    bool working() const { return work() != nullptr; }
    double fact(uint8_t at) const { return facts_[at]; }
    uint32_t refusals() const { return refusals_; }  // messages refused since power-up

private:
    struct Deed {
        Order order;
        uint64_t least_us = 0;
        uint64_t most_us = 0;
    };

    const VerbSpec& verb(const Order& order) const { return device_.verbs[order.verb]; }
    const Deed* work() const;
    bool finishes() const;
    bool faulted() const { return alarmed_ || !sensing_.sane(); }
    bool lets_go(const Order& order) const;
    bool needs_are_met(const VerbSpec& spec) const;
    bool breaks_work(const Order& order) const;
    bool is_over(const Deed& deed) const;
    bool is_measured(const VerbSpec& spec) const;
    uint64_t due_us(const Deed& deed) const;
    uint64_t silent_from_us() const;

    bool move_on();
    bool end_deeds();
    void end(uint8_t at);
    void leave(const Deed& deed);
    void answer(const Deed& deed);
    void look();
    bool read_facts();
    void move_servos();
    void hear(const Message& beat);
    void obey_stop(const Message& stop);
    bool take_numbers(const Message& head);
    void stop(bool latch);
    void break_off(const char* word);
    void begin(const Order& order);
    void supersede(const Order& order);
    void drive(const List<Action>& actions, const double* values);
    void drop(uint8_t at);
    void set_output(uint8_t output, bool on);
    void become(const Deed& deed);
    Refusal objection(const Order& order) const;
    void refuse(Refusal refusal, const Message& head);
    void announce();
    void tell();

    const Device& device_;
    DeviceHardware& hardware_;
    DeviceVoice& voice_;
    Sensing sensing_;
    Servo servos_[kMostServos];
    Uplink uplink_;
    Watch watch_;  // over its work: give that up
    OrderReceipts receipts_;
    Deed deeds_[kMostDeeds];  // in the order in which they began
    uint8_t deeds_count_ = 0;
    double facts_[kMostFacts] = {};
    uint64_t now_us_ = 0;
    uint64_t told_us_ = 0;
    uint32_t boot_id_ = 0;
    uint32_t refusals_ = 0;
    bool latched_ = false;
    bool alarmed_ = false;
    bool was_sane_ = true;
    bool news_ = false;  // an input has changed a fact, which was not told yet
};

}  // namespace arboleda
