// What a board has to know of its robot.
#pragma once

#include <stdint.h>

#include "message.h"

namespace arboleda {

// One axis. Angles are degrees as on the wire: of the joint, or of the pinion of a sliding joint.
struct Joint {
    double least_deg;  // the limits, widened by what rounding on the wire may do
    double most_deg;
    double step_deg;
    double step_si;  // the same step in rad, or in m
    double pinion_m;  // 1 for a joint that turns
    float max_speed_steps_s;
    float acceleration_steps_s2;
    int32_t most_steps;  // the whole way from limit to limit
};

struct Robot {
    uint8_t axes;
    Joint joints[kMostAxes];
};

bool admits(const Joint& joint, double degrees);

// The nearest motor step, halves away from zero; only for what `admits` lets through.
int32_t steps(const Joint& joint, double degrees);

}  // namespace arboleda
