// Which board is built: of an arm, or of a declared device (-DARBOLEDA_DEVICE, with device_config.h beside it).
#pragma once

#ifdef ARBOLEDA_DEVICE
#include "profile_device.h"
#else
#include "profile_arm.h"
#endif
