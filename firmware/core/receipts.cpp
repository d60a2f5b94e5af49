#include "receipts.h"

namespace arboleda {

namespace {

constexpr uint32_t kUnknownSeq = 0;  // senders count from 1
constexpr uint64_t kAheadS = 366 * 86400;   // clocks of two machines differ by no more
constexpr uint64_t kHorizon = 4102444800;   // the year 2100: no plant of this protocol starts later
constexpr const char* kWords[] = {"",       "viejo",   "retenido", "tarde",   "formato",
                                  "limite", "sin_ref", "paro",     "ocupado", "condicion"};

bool same(MaybeNumber one, MaybeNumber other) {
    return one.known == other.known && (!one.known || one.value == other.value);
}

}  // namespace

const char* refusal_word(Refusal refusal) { return kWords[static_cast<uint8_t>(refusal)]; }

Refusal refusal_of_damage(const Message& message) {
    if (!message.well_formed) {
        return Refusal::kFormat;
    }
    return message.retained ? Refusal::kRetained : Refusal::kNone;
}

// The numbers stay until a command comes: a plant that has just begun reads in them what became of the last.
bool Receipts::hear(uint32_t epoch) {
    if (least_.known && epoch <= least_.value) {
        return true;
    }
    const uint64_t ahead = least_.known ? least_.value + kAheadS : kHorizon;
    if (epoch > ahead || epoch > kHorizon) {
        return false;
    }
    least_ = {true, epoch};
    return true;
}

bool Receipts::repeats(const Message& goal) const {
    return goal.seq.known && same(goal.epoch, epoch_) && same(goal.seq, accepted_);
}

Refusal Receipts::objection(const Message& goal) {
    if (!goal.seq.known || !goal.epoch.known) {
        return Refusal::kFormat;
    }
    if (least_.known && goal.epoch.value < least_.value) {
        return Refusal::kOld;
    }
    if (!epoch_.known || goal.epoch.value > epoch_.value) {
        *this = Receipts();
        epoch_ = least_ = goal.epoch;
        return Refusal::kNone;
    }
    const bool newer = !accepted_.known || goal.seq.value > accepted_.value;
    return goal.epoch.value == epoch_.value && newer ? Refusal::kNone : Refusal::kOld;
}

void Receipts::accept(const Message& goal) {
    accepted_ = goal.seq;
    accepted_token_ = goal.token;
}

void Receipts::finish(const Message& goal) {
    if (same(goal.epoch, epoch_)) {
        finished_ = goal.seq;
        finished_token_ = goal.token;
    }
}

void Receipts::refuse(Refusal refusal, MaybeNumber seq, MaybeNumber epoch) {
    // under a foreign epoch a number could be taken for one of the current sender; `viejo` is for the
    // sender of the older epoch, which knows itself by its number
    const bool ours = refusal == Refusal::kOld || !epoch_.known || same(epoch, epoch_);
    refusal_ = refusal;
    refused_ = ours && seq.known ? seq.value : kUnknownSeq;
}

}  // namespace arboleda
