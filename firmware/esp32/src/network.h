// Wi-Fi and MQTT on core 0.
#pragma once

#include "exchange.h"
#include "settings.h"

namespace arboleda {

void start_network(const Settings& settings, Exchange* exchange);

bool on_wifi();
bool on_broker();

}  // namespace arboleda
