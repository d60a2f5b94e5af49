// Written by scripts/firmware-robot from robots/scara.yaml; `make firmware-robot` writes it anew.
#pragma once

#include "robot.h"

namespace arboleda {

constexpr Robot kScara = {
    3,
    {
        // brazo_joint
        {-150.0001, 150.0001,
         0.01929, 0.0003366740127097062, 1.0,
         4665.629860031104F, 9331.259720062208F, 15552},
        // antebrazo_joint
        {-135.0001, 135.0001,
         0.9, 0.015707963267948967, 1.0,
         99.99999999999999F, 199.99999999999997F, 300},
        // efector_joint
        {-0.0001, 254.70010000000005,
         0.9, 0.00035342917352885176, 0.0225,
         169.765272631355F, 565.8842421045167F, 283},
    }};

}  // namespace arboleda
