#include "order_receipts.h"

namespace arboleda {

bool OrderReceipts::is_of_now(const Message& order) const {
    const MaybeNumber now = numbers_.epoch();
    return order.epoch.known == now.known && (!now.known || order.epoch.value == now.value);
}

bool OrderReceipts::repeats(const Message& order) const {
    if (!order.seq.known || !is_of_now(order)) {
        return false;
    }
    for (uint8_t at = 0; at < recent_count_; ++at) {
        if (recent_[at] == order.seq.value) {
            return true;
        }
    }
    return false;
}

Refusal OrderReceipts::objection(const Message& order) {
    const MaybeNumber before = numbers_.epoch();
    const Refusal refusal = numbers_.objection(order);
    const MaybeNumber after = numbers_.epoch();
    if (after.known && (!before.known || after.value != before.value)) {
        recent_count_ = recent_next_ = failures_count_ = 0;
        answer_ = Answer();
    }
    return refusal;
}

void OrderReceipts::accept(const Message& order) {
    numbers_.accept(order);
    recent_[recent_next_] = order.seq.value;
    recent_next_ = static_cast<uint8_t>((recent_next_ + 1) % kKnownOrders);
    recent_count_ = recent_count_ < kKnownOrders ? static_cast<uint8_t>(recent_count_ + 1) : kKnownOrders;
}

void OrderReceipts::answered(const Message& order, uint8_t verb, uint8_t choice) {
    if (is_of_now(order)) {
        answer_ = {order.seq, verb, choice};
    }
}

void OrderReceipts::fail(const Message& order, const char* word) {
    if (!is_of_now(order)) {
        return;
    }
    if (failures_count_ == kFailuresKept) {
        for (uint8_t at = 1; at < kFailuresKept; ++at) {
            failures_[at - 1] = failures_[at];
        }
        --failures_count_;
    }
    failures_[failures_count_++] = {order.seq.value, word};
}

}  // namespace arboleda
