#include "board.h"

namespace arboleda {

namespace {

bool is_stop(const Message& goal) { return goal.channel == Channel::kStop && goal.stop != Stop::kClear; }

}  // namespace

Board::Board(const Config& config, Hardware& hardware, Voice& voice)
    : config_(config),
      hardware_(hardware),
      voice_(voice),
      axes_(config, hardware),
      switches_(config, hardware),
      homing_(config, switches_, axes_) {}

void Board::boot(uint64_t now_us, uint32_t boot_id, bool homed) {
    now_us_ = now_us;
    homing_.cancel();
    axes_.reset();
    switches_.boot(now_us);
    receipts_ = Receipts();
    uplink_.boot();
    watch_.boot(now_us);
    job_ = Job::kNone;
    boot_id_ = boot_id;
    homed_ = homed;
    latched_ = faulted_ = false;
    lost_steps_ = 0;
    announce();
}

void Board::stand_at(const int32_t* steps) {
    for (uint8_t axis = 0; axis < axes_.count(); ++axis) {
        axes_[axis].set_current_position(steps[axis]);
    }
}

void Board::connect(uint64_t now_us, bool up) {
    poll(now_us);
    uplink_.connect(up);
    announce();
}

void Board::fail(uint64_t now_us) {
    poll(now_us);
    faulted_ = true;
    stop(false);
    tell();
}

void Board::repair(uint64_t now_us) {
    poll(now_us);
    faulted_ = false;
    tell();
}

void Board::poll(uint64_t now_us) {
    now_us_ = now_us > now_us_ ? now_us : now_us_;
    if (axes_.moving()) {
        move_on();
    } else {
        switches_.look(now_us_);
    }
    if (uplink_.over(now_us_)) {
        tell();
    }
}

void Board::receive(uint64_t now_us, const Message& message) {
    poll(now_us);
    const Refusal damage = refusal_of_damage(message);
    if (damage != Refusal::kNone) {
        refuse(damage, message);
    } else if (message.channel == Channel::kBeat) {
        hear(message);
    } else {
        obey(message);
    }
}

uint64_t Board::next_us() const {
    uint64_t next = axes_.next_us(now_us_);
    next = earlier(next, silent_from_us());
    next = earlier(next, switches_.next_us());
    return earlier(next, uplink_.due_us());
}

State Board::state() const {
    if (axes_.moving()) {
        return State::kMoving;
    }
    if (faulted_) {
        return State::kFault;
    }
    if (latched_) {
        return State::kLatched;
    }
    return homed_ ? State::kStopped : State::kNotHomed;
}

// Steps, and what comes of them: an arrival, lost steps, the end of patience.
void Board::move_on() {
    if (axes_.stalled(now_us_)) {
        lose_steps();
        return;
    }
    axes_.poll(now_us_);
    switches_.look(now_us_);
    check_way();
    if (!homing_.active() && axes_.arrived(now_us_)) {
        axes_.rest();
        finish();
        tell();
    } else if (silent_from_us() <= now_us_) {
        stop(false);
        tell();
    }
}

// Homing goes on; any other way must not meet a switch.
void Board::check_way() {
    if (homing_.active()) {
        if (homing_.poll() == Homing::Result::kFailed) {
            faulted_ = true;
            stop(false);
        }
        axes_.begin(now_us_);
        return;
    }
    for (uint8_t axis = 0; homed_ && axis < axes_.count(); ++axis) {
        if (switches_.closed(axis)) {
            lose_steps();
            return;
        }
    }
}

void Board::hear(const Message& beat) {
    const bool numbered = config_.level == Level::kIds;
    if (numbered && !receipts_.hear(beat.epoch.value)) {
        refuse(Refusal::kFormat, beat);
    } else {
        watch_.hear(now_us_, beat.epoch.value, receipts_);
    }
}

void Board::obey(const Message& goal) {
    const bool numbered = config_.level == Level::kIds;
    if (is_stop(goal)) {
        stop(goal.stop == Stop::kLatch);
    }
    if (numbered && receipts_.repeats(goal)) {
        tell();
        return;
    }
    const Refusal objection = numbered ? receipts_.objection(goal) : Refusal::kNone;
    const Refusal word = objection != Refusal::kNone ? objection : refusal(goal);
    if (word != Refusal::kNone) {
        refuse(word, goal);
    } else {
        accept(goal);
    }
}

void Board::accept(const Message& goal) {
    watch_.obeyed(now_us_);
    receipts_.accept(goal);
    act(goal);
    tell();
}

Refusal Board::refusal(const Message& goal) const {
    if (goal.channel == Channel::kStop) {
        return Refusal::kNone;
    }
    const Refusal word = objection(goal);
    return word == Refusal::kNone && !uplink_.in_time(now_us_, goal) ? Refusal::kLate : word;
}

// What the board's own state has against a command.
Refusal Board::objection(const Message& goal) const {
    const bool effector = goal.channel == Channel::kEffector;
    if (effector && !goal.on) {
        return Refusal::kNone;
    }
    if (latched_) {
        return Refusal::kStopped;
    }
    if (effector) {
        return Refusal::kNone;
    }
    if (faulted_ || job_ == Job::kHome) {
        return Refusal::kBusy;
    }
    if (goal.channel == Channel::kHome) {
        return Refusal::kNone;
    }
    if (!homed_) {
        return Refusal::kNotHomed;
    }
    return within_limits(goal) ? Refusal::kNone : Refusal::kLimit;
}

bool Board::within_limits(const Message& goal) const {
    for (uint8_t axis = 0; axis < axes_.count(); ++axis) {
        if (!admits(config_.robot->joints[axis], goal.q_deg[axis])) {
            return false;
        }
    }
    return true;
}

void Board::act(const Message& goal) {
    switch (goal.channel) {
        case Channel::kJoints:
            move(goal);
            break;
        case Channel::kHome:
            home();
            take_up(Job::kHome, goal);
            break;
        case Channel::kEffector:
            hardware_.switch_effector(goal.on);
            break;
        default:
            latched_ = latched_ && goal.stop != Stop::kClear;
            break;
    }
}

void Board::take_up(Job job, const Message& goal) {
    job_ = job;
    job_goal_ = goal;
}

void Board::move(const Message& goal) {
    int32_t targets[kMostAxes] = {};
    for (uint8_t axis = 0; axis < axes_.count(); ++axis) {
        targets[axis] = steps(config_.robot->joints[axis], goal.q_deg[axis]);
    }
    axes_.start(now_us_, targets);
    take_up(Job::kMove, goal);
}

void Board::home() {
    homed_ = false;
    if (config_.home_by == HomeBy::kKnown) {
        axes_.home(now_us_);
        return;
    }
    homing_.start();
    homing_.poll();
    axes_.begin(now_us_);
}

// Told again, a ramp on its way down goes on as it is.
void Board::stop(bool latch) {
    const bool obeyed = job_ != Job::kNone;
    job_ = Job::kNone;
    latched_ = latched_ || latch;
    homing_.cancel();
    if (latch && config_.effector_on_stop == OnStop::kRelease) {
        hardware_.switch_effector(false);
    }
    if (axes_.moving() && obeyed) {
        axes_.stop(now_us_);
    }
}

void Board::finish() {
    if (job_ != Job::kNone) {
        receipts_.finish(job_goal_);
        homed_ = homed_ || job_ == Job::kHome;
    }
    job_ = Job::kNone;
}

// The counters are wrong from here on: stand still and ask for homing.
void Board::lose_steps() {
    ++lost_steps_;
    job_ = Job::kNone;
    homed_ = false;
    homing_.cancel();
    axes_.freeze();
    tell();
}

void Board::refuse(Refusal refusal, const Message& message) {
    ++refusals_;
    receipts_.refuse(refusal, message.seq, message.epoch);
    tell();
}

void Board::announce() {
    uplink_.begin(now_us_);
    if (uplink_.connected()) {
        voice_.present();
    }
    tell();
}

void Board::tell() {
    if (uplink_.connected()) {
        voice_.tell(telemetry(uplink_.tell(now_us_)));
    }
}

Telemetry Board::telemetry(uint32_t number) {
    Telemetry said;
    said.level = config_.level;
    said.state = state();
    said.axes = axes_.count();
    for (uint8_t axis = 0; axis < said.axes; ++axis) {
        said.q_deg[axis] = axes_.degrees(axis);
    }
    said.number = number;
    said.receipts = receipts_;
    said.boot_id = boot_id_;
    said.homed = homed_;
    said.effector = hardware_.effector();
    said.has_piece_sensor = config_.has_piece_sensor;
    said.piece = config_.has_piece_sensor && hardware_.piece();
    return said;
}

// When the silence gets too long; kNever unless it is watched.
uint64_t Board::silent_from_us() const {
    return axes_.moving() && job_ != Job::kNone ? watch_.silent_from_us() : kNever;
}

}  // namespace arboleda
