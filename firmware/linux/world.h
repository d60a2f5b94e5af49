// An arm that is not there: where its axes truly are, its switches, its effector and the parts at its places.
#pragma once

#include "../core/config.h"
#include "../core/hardware.h"

namespace arboleda {

constexpr int kMostPlaces = 40;  // a cell has at most 36 exits, and what palletizing picks

class World final : public Hardware {
public:
    explicit World(const Config& config) : config_(config) {}

    void put(const int32_t* steps);     // a hand moves the axes there
    void add_place(const int32_t* steps);  // a part lies ready here
    void power_up();                    // the output is off, what it held falls
    void slip(uint8_t axis, int32_t steps) { true_steps_[axis] += steps; }
    void drop() { holding_ = false; }

    bool supplied = true;  // parts lie at the places
    bool grips = true;     // the effector closes on them
    bool stuck = false;    // the effector does not follow its switch
    bool pressed[kMostAxes] = {};  // a finger is on its homing switch

    void step(uint8_t axis, bool forward) override { true_steps_[axis] += forward ? 1 : -1; }
    bool at_switch(uint8_t axis) override;
    int32_t true_steps(uint8_t axis) override { return true_steps_[axis]; }
    void moving(bool moving) override;
    void switch_effector(bool on) override;
    bool effector() override { return effector_; }
    bool piece() override { return holding_ || piece_lies_here(); }

private:
    bool piece_lies_here() const;
    void grip();

    const Config& config_;
    int32_t true_steps_[kMostAxes] = {};
    int32_t places_[kMostPlaces][kMostAxes] = {};
    int places_count_ = 0;
    bool moving_ = false;
    bool effector_ = false;
    bool holding_ = false;
};

}  // namespace arboleda
