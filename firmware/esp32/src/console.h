// The serial console: shows and sets what is kept in flash.
#pragma once

#include "exchange.h"
#include "settings.h"

namespace arboleda {

void turn_console(const Settings& settings, const Exchange& exchange);

}  // namespace arboleda
