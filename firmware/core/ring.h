// A queue between two tasks, one that puts and one that takes; neither ever waits for the other.
#pragma once

#include <stdint.h>

namespace arboleda {

template <typename Item, uint32_t kCapacity>
class Ring {
    static_assert((kCapacity & (kCapacity - 1)) == 0, "a power of two");

public:
    bool put(const Item& item) {  // false: full, and the item is not kept
        const uint32_t head = __atomic_load_n(&head_, __ATOMIC_RELAXED);
        if (head - __atomic_load_n(&tail_, __ATOMIC_ACQUIRE) == kCapacity) {
            return false;
        }
        items_[head % kCapacity] = item;
        __atomic_store_n(&head_, head + 1, __ATOMIC_RELEASE);
        return true;
    }

    bool take(Item* item) {  // false: empty
        const uint32_t tail = __atomic_load_n(&tail_, __ATOMIC_RELAXED);
        if (tail == __atomic_load_n(&head_, __ATOMIC_ACQUIRE)) {
            return false;
        }
        *item = items_[tail % kCapacity];
        __atomic_store_n(&tail_, tail + 1, __ATOMIC_RELEASE);
        return true;
    }

private:
    Item items_[kCapacity] = {};
    uint32_t head_ = 0;
    uint32_t tail_ = 0;
};

}  // namespace arboleda
