#include "robot.h"

namespace arboleda {

namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;

}  // namespace

bool admits(const Joint& joint, double degrees) {
    return joint.least_deg <= degrees && degrees <= joint.most_deg;
}

int32_t steps(const Joint& joint, double degrees) {
    const double value = degrees * kRadPerDeg * joint.pinion_m;
    const double magnitude = value < 0.0 ? -value : value;
    const auto nearest = static_cast<int32_t>(magnitude / joint.step_si + 0.5);
    return value < 0.0 ? -nearest : nearest;
}

}  // namespace arboleda
