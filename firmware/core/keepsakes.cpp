#include "keepsakes.h"

namespace arboleda {

namespace {

constexpr uint32_t kOff = 0x0FF0FF0F;
constexpr uint32_t kOn = 0x600D0A11;
constexpr uint32_t kChanceBits = 12;

}  // namespace

uint32_t boot_id(uint32_t boots_counted, uint32_t chance) {
    return (boots_counted + 1) << kChanceBits | (chance & ((1U << kChanceBits) - 1));
}

KeptEffector keep(bool on) {
    const uint32_t said = on ? kOn : kOff;
    return {said, ~said};
}

bool kept_on(const KeptEffector& kept) { return kept.said == kOn && kept.check == ~kOn; }

}  // namespace arboleda
