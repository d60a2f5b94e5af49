// Runs the stepper through recorded scenarios and prints every step; the same program on the host and on rv32imc.
#include <stdio.h>

#include "../core/stepper.h"
#include "scenarios.h"  // made by test/scenarios.py from wire_vectors/stepper

namespace {

using namespace arboleda;

void command(Stepper& stepper, const Command& command) {
    switch (command.what) {
        case What::kSetAcceleration:
            stepper.set_acceleration(static_cast<float>(command.value));
            break;
        case What::kSetMaxSpeed:
            stepper.set_max_speed(static_cast<float>(command.value));
            break;
        case What::kMoveTo:
            stepper.move_to(static_cast<int32_t>(command.value));
            break;
        case What::kStop:
            stepper.stop();
            break;
        case What::kSetCurrentPosition:
            stepper.set_current_position(static_cast<int32_t>(command.value));
            break;
    }
}

// The first poll that is not earlier, outside the gap.
uint32_t poll_at(const Scenario& scenario, uint32_t time_us) {
    const uint32_t end_us = scenario.gap_start_us + scenario.gap_us;
    const uint32_t from_us = time_us >= scenario.gap_start_us && time_us < end_us ? end_us : time_us;
    return (from_us + scenario.poll_us - 1) / scenario.poll_us * scenario.poll_us;
}

// The time of the next event; false where there is none.
bool next(const Scenario& scenario, const Stepper& stepper, size_t done, uint32_t now_us, uint32_t* next_us) {
    const bool commands = done < scenario.count;
    const uint32_t step_us = now_us + stepper.wait_us(scenario.boot_us + now_us);
    const uint32_t command_us = commands ? scenario.commands[done].at_us : step_us;
    *next_us = stepper.still() || command_us < step_us ? command_us : step_us;
    return commands || !stepper.still();
}

void trace(const Scenario& scenario) {
    Stepper stepper;
    size_t done = 0;
    printf("%s\n", scenario.name);
    for (uint32_t now_us = 0, due_us = 0;; now_us = poll_at(scenario, due_us)) {
        while (done < scenario.count && scenario.commands[done].at_us <= now_us) {
            command(stepper, scenario.commands[done++]);
        }
        if (stepper.run(scenario.boot_us + now_us)) {
            printf("%lu %ld\n", static_cast<unsigned long>(now_us), static_cast<long>(stepper.position()));
        }
        if (!next(scenario, stepper, done, now_us + 1, &due_us)) {
            return;
        }
    }
}

}  // namespace

int main() {
    for (const Scenario& scenario : kScenarios) {
        trace(scenario);
    }
    return 0;
}
