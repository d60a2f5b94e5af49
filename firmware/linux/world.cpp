#include "world.h"

#include <string.h>

namespace arboleda {

void World::put(const int32_t* steps) { memcpy(true_steps_, steps, sizeof(int32_t) * config_.robot->axes); }

void World::add_place(const int32_t* steps) {
    if (places_count_ < kMostPlaces) {
        memcpy(places_[places_count_++], steps, sizeof(int32_t) * config_.robot->axes);
    }
}

void World::power_up() { effector_ = holding_ = false; }

bool World::at_switch(uint8_t axis) {
    const HomeWay& way = config_.home[axis];
    const int32_t beyond = (true_steps_[axis] - way.switch_steps) * way.direction;
    return pressed[axis] || beyond >= 0;
}

void World::moving(bool moving) {
    moving_ = moving;
    grip();
}

void World::switch_effector(bool on) {
    if (stuck) {
        return;
    }
    effector_ = on;
    holding_ = holding_ && on;
    grip();
}

bool World::piece_lies_here() const {
    for (int place = 0; supplied && !moving_ && place < places_count_; ++place) {
        if (memcmp(places_[place], true_steps_, sizeof(int32_t) * config_.robot->axes) == 0) {
            return true;
        }
    }
    return false;
}

void World::grip() { holding_ = holding_ || (effector_ && grips && piece_lies_here()); }

}  // namespace arboleda
