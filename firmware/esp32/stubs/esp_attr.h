// What the port uses of ESP-IDF 4.4, for a syntax check only.
#pragma once

#define RTC_NOINIT_ATTR
