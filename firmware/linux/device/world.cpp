#include "world.h"

namespace arboleda {

namespace {

// The counts of an analog input that is worth so much.
uint16_t counts_of(const AnalogWiring& wiring, double value) {
    const double counts = (value - wiring.offset) / wiring.per_count;
    return static_cast<uint16_t>(counts < 0.0 ? 0.0 : counts > 4095.0 ? 4095.0 : counts + 0.5);
}

}  // namespace

DeviceWorld::DeviceWorld(const Device& device) : device_(device) {
    for (uint8_t at = 0; at < device.inputs.count; ++at) {
        levels_[at] = device.inputs[at].active_low;
    }
    for (uint8_t at = 0; at < device.analogs.count; ++at) {
        counts_[at] = counts_of(device.analogs[at], 0.0);
    }
    for (const FactSpec& fact : device.facts) {
        show(fact.reading, fact.first);
    }
}

void DeviceWorld::begun(const Order& order) {
    if (efforts_count_ == kMostDeeds) {
        return;  // more switches at once than a board has: nobody waits for this one
    }
    efforts_[efforts_count_++] = {order, now_us_ + verb(order).takes_us};
}

uint64_t DeviceWorld::next_us() const {
    uint64_t next = UINT64_MAX;
    for (uint8_t at = 0; at < efforts_count_; ++at) {
        next = efforts_[at].due_us < next ? efforts_[at].due_us : next;
    }
    return next;
}

void DeviceWorld::advance(uint64_t now_us, bool working) {
    now_us_ = now_us;
    for (uint8_t at = 0; at < efforts_count_;) {
        const Effort effort = efforts_[at];
        const bool halted = !working && is_work(verb(effort.order));
        if (!halted && effort.due_us > now_us) {
            ++at;
            continue;
        }
        --efforts_count_;
        for (uint8_t next = at; next < efforts_count_; ++next) {
            efforts_[next] = efforts_[next + 1];
        }
        if (!halted && !stuck) {
            follow(effort.order);
        }
    }
}

void DeviceWorld::follow(const Order& order) {
    for (const Setting& setting : verb(order).sets) {
        const FactSpec& fact = device_.facts[setting.fact];
        if (fact.source == Source::kInputs) {
            show(fact.reading, given(setting.value, order.values));
        }
    }
}

// The inputs of the row of this value, and none of any other.
void DeviceWorld::show(const Reading& reading, double value) {
    for (const Row& row : reading.rows) {
        for (const Condition& condition : row.when) {
            put(condition.input, row.value == value ? condition.on : !condition.on);
        }
    }
    for (const Row& row : reading.rows) {
        for (const Condition& condition : row.when) {
            if (row.value == value) {
                put(condition.input, condition.on);
            }
        }
    }
}

void DeviceWorld::put(uint8_t at, bool on) {
    const InputWiring& input = device_.inputs[at];
    if (input.analog == kAbsent) {
        levels_[at] = on != input.active_low;
        return;
    }
    const AnalogWiring& analog = device_.analogs[static_cast<uint8_t>(input.analog)];
    const double gap = input.on_above - input.off_below + analog.step;
    counts_[input.analog] = counts_of(analog, on ? input.on_above + gap : input.off_below - gap);
}

}  // namespace arboleda
