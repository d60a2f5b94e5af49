// The motion task on core 1: the only one that touches the board, and never the network.
#pragma once

#include "exchange.h"
#include "settings.h"

namespace arboleda {

void start_motion(const Settings& settings, uint32_t boot_id, Exchange* exchange);

}  // namespace arboleda
