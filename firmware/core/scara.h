// The SCARA's board as it is configured from the factory; the numbers of its joints are in robot_scara.h.
#pragma once

#include "config.h"
#include "robot_scara.h"

namespace arboleda {

// Switches lie beyond a limit; q3 goes up before the arm turns.
inline Config scara_config() {
    Config config;
    config.robot = &kScara;
    config.has_piece_sensor = true;
    config.home[0] = {-1, 1, -7880, 260, 3000.0F, 100.0F};  // -152 deg
    config.home[1] = {-1, 1, -153, 8, 60.0F, 10.0F};        // -137.7 deg
    config.home[2] = {-1, 0, -6, 8, 80.0F, 20.0F};          // 2.1 mm above 0
    return config;
}

}  // namespace arboleda
