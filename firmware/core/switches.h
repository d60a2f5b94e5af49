// The homing switches, debounced; nobody looks at them where homing is by HomeBy::kKnown.
#pragma once

#include "config.h"
#include "debounced.h"
#include "hardware.h"

namespace arboleda {

class Switches {
public:
    Switches(const Config& config, Hardware& hardware) : config_(config), hardware_(hardware) {}

    void boot(uint64_t now_us) {  // open, until they were seen closed for long enough
        for (Debounced& each : switches_) {
            each.begin(now_us, false);
        }
    }

    // After the steps of a poll, so that a step that closes a switch is not followed by another one unseen.
    void look(uint64_t now_us) {
        for (uint8_t axis = 0; axis < count(); ++axis) {
            switches_[axis].see(now_us, hardware_.at_switch(axis), config_.debounce_us);
        }
    }

    bool closed(uint8_t axis) const { return switches_[axis].on(); }

    // When to look again, so that none counts later than it could; kNever where all that was seen counts.
    uint64_t next_us() const {
        uint64_t next = kNever;
        for (uint8_t axis = 0; axis < count(); ++axis) {
            next = earlier(next, switches_[axis].counts_us(config_.debounce_us));
        }
        return next;
    }

private:
    uint8_t count() const { return config_.home_by == HomeBy::kSwitches ? config_.robot->axes : 0; }

    const Config& config_;
    Hardware& hardware_;
    Debounced switches_[kMostAxes];
};

}  // namespace arboleda
