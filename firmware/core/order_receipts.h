// The numbers of a device's orders: what a board of an arm keeps, and the last eight accepted, the last answer,
// the last few that were given up. All count only for the epoch of `numbers()`.
#pragma once

#include "receipts.h"

namespace arboleda {

constexpr uint8_t kKnownOrders = 8;
constexpr uint8_t kFailuresKept = 3;

struct Failure {
    uint32_t seq = 0;
    const char* word = "";
};

struct Answer {
    MaybeNumber seq;
    uint8_t verb = 0;
    uint8_t choice = 0;
};

class OrderReceipts {
public:
    bool hear(uint32_t epoch) { return numbers_.hear(epoch); }
    bool repeats(const Message& order) const;
    Refusal objection(const Message& order);
    void accept(const Message& order);
    void finish(const Message& order) { numbers_.finish(order); }
    void refuse(Refusal refusal, MaybeNumber seq, MaybeNumber epoch) { numbers_.refuse(refusal, seq, epoch); }
    void answered(const Message& order, uint8_t verb, uint8_t choice);
    void fail(const Message& order, const char* word);

    const Receipts& numbers() const { return numbers_; }
    const Answer& answer() const { return answer_; }
    uint8_t failures() const { return failures_count_; }
    const Failure& failure(uint8_t at) const { return failures_[at]; }

private:
    bool is_of_now(const Message& order) const;

    Receipts numbers_;
    uint32_t recent_[kKnownOrders] = {};
    uint8_t recent_count_ = 0;
    uint8_t recent_next_ = 0;
    Answer answer_;
    Failure failures_[kFailuresKept];
    uint8_t failures_count_ = 0;
};

}  // namespace arboleda
