#include "device_board.h"

namespace arboleda {

namespace {

constexpr const char* kSilent = "silencio";
constexpr const char* kAlarm = "alarma";
constexpr const char* kOverdue = "plazo";         // inputs did not say in time that it is done
constexpr const char* kSuperseded = "relevado";   // another order for the same fact came
constexpr const char* kUnanswered = "sin_dato";  // inputs contradict each other

}  // namespace

DeviceBoard::DeviceBoard(const Device& device, DeviceHardware& hardware, DeviceVoice& voice)
    : device_(device), hardware_(hardware), voice_(voice), sensing_(device, hardware) {}

void DeviceBoard::boot(uint64_t now_us, uint32_t boot_id) {
    now_us_ = now_us;
    boot_id_ = boot_id;
    deeds_count_ = 0;
    receipts_ = OrderReceipts();
    uplink_.boot();
    watch_.boot(now_us);
    latched_ = alarmed_ = news_ = false;
    was_sane_ = true;
    for (uint8_t at = 0; at < device_.outputs.count; ++at) {
        set_output(at, device_.outputs[at].safe_on);
    }
    for (uint8_t at = 0; at < device_.servos.count; ++at) {
        servos_[at].reset();
        hardware_.pulse(at, 0);
    }
    for (uint8_t at = 0; at < device_.facts.count; ++at) {
        facts_[at] = device_.facts[at].first;
    }
    sensing_.begin(now_us);
    read_facts();
    announce();
}

void DeviceBoard::connect(uint64_t now_us, bool up) {
    poll(now_us);
    uplink_.connect(up);
    announce();
}

void DeviceBoard::fail(uint64_t now_us) {
    poll(now_us);
    alarmed_ = true;
    break_off(kAlarm);
    tell();
}

void DeviceBoard::repair(uint64_t now_us) {
    poll(now_us);
    alarmed_ = false;
    tell();
}

void DeviceBoard::poll(uint64_t now_us) {
    now_us_ = now_us > now_us_ ? now_us : now_us_;
    look();
    if (move_on()) {
        tell();
    } else if (news_ && now_us_ - told_us_ >= kLeastGapUs) {
        tell();
    }
    if (uplink_.over(now_us_)) {
        tell();
    }
}

void DeviceBoard::receive(uint64_t now_us, const Message& message) {
    poll(now_us);
    const Refusal damage = refusal_of_damage(message);
    if (damage != Refusal::kNone) {
        refuse(damage, message);
    } else if (message.channel == Channel::kBeat) {
        hear(message);
    } else {
        obey_stop(message);
    }
}

void DeviceBoard::receive(uint64_t now_us, const Order& order) {
    poll(now_us);
    const Refusal damage = refusal_of_damage(order.head);
    if (damage != Refusal::kNone) {
        refuse(damage, order.head);
        return;
    }
    if (!take_numbers(order.head)) {
        return;
    }
    const Refusal word = objection(order);
    if (word != Refusal::kNone) {
        refuse(word, order.head);
        return;
    }
    watch_.obeyed(now_us_);
    receipts_.accept(order.head);
    begin(order);
    tell();
}

uint64_t DeviceBoard::next_us() const {
    uint64_t next = earlier(sensing_.next_us(), silent_from_us());
    for (uint8_t at = 0; at < deeds_count_; ++at) {
        next = earlier(next, due_us(deeds_[at]));
    }
    for (uint8_t at = 0; at < device_.servos.count; ++at) {
        next = earlier(next, servos_[at].next_us());
    }
    next = news_ && uplink_.connected() ? earlier(next, told_us_ + kLeastGapUs) : next;
    return earlier(next, uplink_.due_us());
}

State DeviceBoard::state() const {
    if (working()) {
        return State::kMoving;
    }
    if (faulted()) {
        return State::kFault;
    }
    return latched_ ? State::kLatched : State::kStopped;
}

const DeviceBoard::Deed* DeviceBoard::work() const {
    for (uint8_t at = 0; at < deeds_count_; ++at) {
        if (is_work(verb(deeds_[at].order))) {
            return &deeds_[at];
        }
    }
    return nullptr;
}

bool DeviceBoard::finishes() const { return working() && verb(work()->order).finishes; }

// Inputs and servos, as they are by now.
void DeviceBoard::look() {
    move_servos();
    if (!sensing_.poll(now_us_)) {
        return;
    }
    news_ = read_facts() || news_;
    if (sensing_.sane() != was_sane_) {
        was_sane_ = sensing_.sane();
        if (!was_sane_) {
            break_off(kAlarm);
        }
        tell();
    }
}

void DeviceBoard::move_servos() {
    for (uint8_t at = 0; at < device_.servos.count; ++at) {
        servos_[at].poll(now_us_, at, device_.servos[at], hardware_);
    }
}

// Facts as inputs say them; whether one has changed that is told at once. Measured numbers wait for their turn.
bool DeviceBoard::read_facts() {
    bool changed = false;
    for (uint8_t at = 0; at < device_.facts.count; ++at) {
        const FactSpec& fact = device_.facts[at];
        double value = facts_[at];
        if (fact.source == Source::kAnalog) {
            facts_[at] = sensing_.value(fact.analog);
        } else if (fact.source == Source::kInputs && sensing_.read(fact.reading, &value)) {
            changed = changed || value != facts_[at];
            facts_[at] = value;
        }
    }
    return changed;
}

// Whether something has ended: work, a switch, a query, or the patience with a silent plant.
bool DeviceBoard::move_on() {
    const bool ended = end_deeds();
    if (silent_from_us() <= now_us_) {
        break_off(kSilent);
        return true;
    }
    return ended;
}

bool DeviceBoard::end_deeds() {
    bool ended = false;
    for (uint8_t at = 0; at < deeds_count_;) {
        const Deed& deed = deeds_[at];
        if (is_over(deed)) {
            end(at);
            ended = true;
        } else if (deed.most_us <= now_us_) {
            receipts_.fail(deed.order.head, kOverdue);
            leave(deed);
            drop(at);
            ended = true;
        } else {
            ++at;
        }
    }
    return ended;
}

bool DeviceBoard::is_over(const Deed& deed) const {
    if (now_us_ < deed.least_us) {
        return false;
    }
    const VerbSpec& spec = verb(deed.order);
    for (const Action& action : spec.start) {
        if (action.drive == Drive::kServo && servos_[action.index].moving()) {
            return false;
        }
    }
    for (const Setting& setting : spec.sets) {
        const bool looked_at = device_.facts[setting.fact].source != Source::kTold;
        if (looked_at && facts_[setting.fact] != given(setting.value, deed.order.values)) {
            return false;
        }
    }
    return true;
}

void DeviceBoard::end(uint8_t at) {
    const Deed deed = deeds_[at];
    const VerbSpec& spec = verb(deed.order);
    become(deed);
    leave(deed);
    drop(at);
    if (spec.effect == Effect::kQuery) {
        answer(deed);
    } else if (is_work(spec)) {
        receipts_.finish(deed.order.head);
    }
}

void DeviceBoard::become(const Deed& deed) {
    for (const Setting& setting : verb(deed.order).sets) {
        if (device_.facts[setting.fact].source == Source::kTold) {
            facts_[setting.fact] = given(setting.value, deed.order.values);
        }
    }
}

// What is done whenever an order ends: outputs that only belong to it.
void DeviceBoard::leave(const Deed& deed) {
    const VerbSpec& spec = verb(deed.order);
    for (const Action& action : spec.start) {
        if (action.drive == Drive::kServo) {
            servos_[action.index].stop();
        }
    }
    drive(spec.end, deed.order.values);
}

void DeviceBoard::answer(const Deed& deed) {
    double choice = 0.0;
    if (sensing_.read(verb(deed.order).answer, &choice)) {
        receipts_.answered(deed.order.head, deed.order.verb, static_cast<uint8_t>(choice));
    } else {
        receipts_.fail(deed.order.head, kUnanswered);
    }
}

void DeviceBoard::hear(const Message& beat) {
    if (!receipts_.hear(beat.epoch.value)) {
        refuse(Refusal::kFormat, beat);
    } else {
        watch_.hear(now_us_, beat.epoch.value, receipts_.numbers());
    }
}

void DeviceBoard::obey_stop(const Message& message) {
    if (message.stop != Stop::kClear) {
        stop(message.stop == Stop::kLatch);
    }
    if (!take_numbers(message)) {
        return;
    }
    watch_.obeyed(now_us_);
    receipts_.accept(message);
    latched_ = latched_ && message.stop != Stop::kClear;
    tell();
}

// False: a copy, or a number that does not count; that was said.
bool DeviceBoard::take_numbers(const Message& head) {
    if (receipts_.repeats(head)) {
        tell();
        return false;
    }
    const Refusal word = receipts_.objection(head);
    if (word != Refusal::kNone) {
        refuse(word, head);
        return false;
    }
    return true;
}

Refusal DeviceBoard::objection(const Order& order) const {
    if (!order.known) {
        return Refusal::kFormat;
    }
    const VerbSpec& spec = verb(order);
    if (latched_ && spec.effect != Effect::kQuery && !lets_go(order)) {
        return Refusal::kStopped;
    }
    if (is_work(spec) && (working() || faulted())) {
        return Refusal::kBusy;
    }
    if (!needs_are_met(spec) || breaks_work(order)) {
        return Refusal::kCondition;
    }
    return uplink_.in_time(now_us_, order.head) ? Refusal::kNone : Refusal::kLate;
}

bool DeviceBoard::lets_go(const Order& order) const {
    const VerbSpec& spec = verb(order);
    for (const Setting& setting : spec.sets) {
        if (setting.fact == spec.held_fact) {
            return given(setting.value, order.values) == 0.0;
        }
    }
    return false;
}

bool DeviceBoard::needs_are_met(const VerbSpec& spec) const {
    for (const Need& need : spec.needs) {
        if (facts_[need.fact] != need.value) {
            return false;
        }
    }
    return true;
}

// Whether it would end what the work under way needs.
bool DeviceBoard::breaks_work(const Order& order) const {
    if (!working()) {
        return false;
    }
    for (const Need& need : verb(work()->order).needs) {
        for (const Setting& setting : verb(order).sets) {
            if (setting.fact == need.fact && given(setting.value, order.values) != need.value) {
                return true;
            }
        }
    }
    return false;
}

// Even what takes no time takes a moment.
void DeviceBoard::begin(const Order& order) {
    supersede(order);
    const VerbSpec& spec = verb(order);
    const uint64_t least_us = spec.least_us > 0 ? spec.least_us : 1;
    const uint64_t most_us = is_measured(spec) ? now_us_ + spec.most_us : kNever;
    deeds_[deeds_count_++] = {order, now_us_ + least_us, most_us};
    drive(spec.start, order.values);
    hardware_.begun(order);
}

// A query before this one is forgotten; a switch of the same fact is over, short of its end.
void DeviceBoard::supersede(const Order& order) {
    const Effect effect = verb(order).effect;
    for (uint8_t at = 0; at < deeds_count_;) {
        const Deed& deed = deeds_[at];
        const bool is_switch = verb(deed.order).effect == Effect::kSwitch;
        bool same = effect == Effect::kQuery && verb(deed.order).effect == Effect::kQuery;
        for (const Setting& one : verb(order).sets) {
            for (const Setting& other : verb(deed.order).sets) {
                same = same || (is_switch && one.fact == other.fact);
            }
        }
        if (same && is_switch) {
            receipts_.fail(deed.order.head, kSuperseded);
        }
        if (same) {
            drop(at);
        } else {
            ++at;
        }
    }
}

void DeviceBoard::drop(uint8_t at) {
    --deeds_count_;
    for (; at < deeds_count_; ++at) {
        deeds_[at] = deeds_[at + 1];
    }
}

void DeviceBoard::drive(const List<Action>& actions, const double* values) {
    for (const Action& action : actions) {
        const double value = given(action.value, values);
        if (action.drive == Drive::kServo) {
            servos_[action.index].start(now_us_, value, device_.servos[action.index]);
        } else {
            set_output(action.index, value != 0.0);
        }
    }
    move_servos();
}

void DeviceBoard::set_output(uint8_t output, bool on) {
    hardware_.set_level(output, on != device_.outputs[output].active_low);
}

void DeviceBoard::stop(bool latch) {
    latched_ = latched_ || latch;
    if (!finishes()) {
        break_off(nullptr);
    }
    for (uint8_t at = 0; latch && at < device_.outputs.count; ++at) {
        if (device_.outputs[at].safe_on_stop) {
            set_output(at, device_.outputs[at].safe_on);
        }
    }
}

// Ends work where it is; with a word, it was the board itself that did so.
void DeviceBoard::break_off(const char* word) {
    for (uint8_t at = 0; at < deeds_count_; ++at) {
        if (is_work(verb(deeds_[at].order))) {
            const Deed deed = deeds_[at];
            leave(deed);
            drop(at);
            if (word != nullptr) {
                receipts_.fail(deed.order.head, word);
            }
            return;
        }
    }
}

bool DeviceBoard::is_measured(const VerbSpec& spec) const {
    for (const Setting& setting : spec.sets) {
        if (device_.facts[setting.fact].source != Source::kTold) {
            return true;
        }
    }
    return false;
}

// When time alone can end it; inputs are looked at by themselves.
uint64_t DeviceBoard::due_us(const Deed& deed) const {
    return deed.least_us > now_us_ ? deed.least_us : earlier(deed.most_us, sensing_.next_us());
}

// When the silence gets too long; kNever unless it is watched.
uint64_t DeviceBoard::silent_from_us() const {
    return working() && !finishes() ? watch_.silent_from_us() : kNever;
}

void DeviceBoard::refuse(Refusal refusal, const Message& head) {
    ++refusals_;
    receipts_.refuse(refusal, head.seq, head.epoch);
    tell();
}

void DeviceBoard::announce() {
    uplink_.begin(now_us_);
    if (uplink_.connected()) {
        voice_.present();
    }
    tell();
}

void DeviceBoard::tell() {
    if (!uplink_.connected()) {
        return;
    }
    told_us_ = now_us_;
    news_ = false;
    DeviceTelemetry said;
    said.state = state();
    said.number = uplink_.tell(now_us_);
    said.receipts = receipts_;
    said.boot_id = boot_id_;
    for (uint8_t at = 0; at < device_.facts.count; ++at) {
        said.facts[at] = facts_[at];
    }
    voice_.tell(said);
}

}  // namespace arboleda
