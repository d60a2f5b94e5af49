// A row of constants of somebody else's.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace arboleda {

template <typename Item>
struct List {
    const Item* items = nullptr;
    uint8_t count = 0;

    constexpr const Item* begin() const { return items; }
    constexpr const Item* end() const { return items + count; }
    constexpr const Item& operator[](uint8_t at) const { return items[at]; }
};

template <typename Item, size_t kCount>
constexpr List<Item> list(const Item (&items)[kCount]) {
    static_assert(kCount < 256, "more than a board has room for");
    return {items, static_cast<uint8_t>(kCount)};
}

}  // namespace arboleda
