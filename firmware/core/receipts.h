// The (epoca, seq) rules of a board: which command counts, and what its telemetry says about it.
#pragma once

#include "message.h"

namespace arboleda {

enum class Refusal : uint8_t {
    kNone, kOld, kRetained, kLate, kFormat, kLimit, kNotHomed, kStopped, kBusy, kCondition
};

// The word of a refusal on the wire, `viejo`, ...; not for kNone.
const char* refusal_word(Refusal refusal);

// Of what is refused whole, whatever it says; kNone where it is looked at further.
Refusal refusal_of_damage(const Message& message);

// All numbers count only for `epoch`.
class Receipts {
public:
    bool hear(uint32_t epoch);  // a beat: older commands count no more; false where no plant can have that epoch
    bool repeats(const Message& goal) const;   // the last accepted command once more: QoS 1 delivers twice
    Refusal objection(const Message& goal);    // a fresh command makes its epoch the current one
    void accept(const Message& goal);
    void finish(const Message& goal);
    void refuse(Refusal refusal, MaybeNumber seq, MaybeNumber epoch);

    MaybeNumber epoch() const { return epoch_; }
    MaybeNumber least() const { return least_; }  // the oldest epoch that still counts
    MaybeNumber accepted() const { return accepted_; }
    MaybeNumber finished() const { return finished_; }
    const char* accepted_token() const { return accepted_token_.text; }
    const char* finished_token() const { return finished_token_.text; }
    Refusal refusal() const { return refusal_; }
    uint32_t refused() const { return refused_; }

private:
    MaybeNumber epoch_;
    MaybeNumber least_;
    MaybeNumber accepted_;
    MaybeNumber finished_;
    Token accepted_token_;
    Token finished_token_;
    Refusal refusal_ = Refusal::kNone;
    uint32_t refused_ = 0;
};

}  // namespace arboleda
