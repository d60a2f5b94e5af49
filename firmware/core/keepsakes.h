// What outlives a reset: the boot counter in flash, and the effector's last state in RTC memory.
#pragma once

#include <stdint.h>

namespace arboleda {

constexpr uint64_t kCountBootAfterUs = 5000000;  // spares the flash of a board that resets in a circle

// A boot id: the counter above, chance below, so that a boot that never gets counted is still told apart.
uint32_t boot_id(uint32_t boots_counted, uint32_t chance);

// The effector's state with a check that memory after a cold start does not pass.
struct KeptEffector {
    uint32_t said;
    uint32_t check;
};

KeptEffector keep(bool on);
bool kept_on(const KeptEffector& kept);  // off, unless it was kept on

}  // namespace arboleda
