// What is soldered: pins, levels, directions, switches. Change it here to fit your wiring.
#pragma once

#include <stdint.h>

#include "scara.h"

namespace arboleda {

struct AxisPins {
    int8_t step;
    int8_t direction;
    int8_t home_switch;  // closes to ground
    bool reversed;       // the motor turns the other way round
};

constexpr AxisPins kAxisPins[] = {
    {25, 26, 34, false},  // q1
    {27, 14, 35, false},  // q2
    {16, 17, 36, false},  // q3
};
constexpr int8_t kEnablePin = 33;    // low: the drivers hold their motors
constexpr int8_t kEffectorPin = 32;  // high: on; a pull-down holds it off in reset
constexpr int8_t kPiecePin = 39;     // low: a part is there; -1: no sensor
constexpr int8_t kAlarmPin = -1;     // low: a driver's alarm; -1: none

constexpr uint32_t kPulseUs = 3;      // how long a driver needs to see a step
constexpr uint32_t kDirectionUs = 5;  // and a new direction before it

// Pins 34 to 39 have no pull-up of their own: a resistor of 10 k to 3.3 V belongs to each switch.

#ifdef ARBOLEDA_TLS
// Files of docs/how-to/tls.md: rootCA.pem, then clients/NAME.crt and .key where the broker asks for a certificate of
// the board. Empty: it shows none.
constexpr char kBrokerCa[] = R"(-----BEGIN CERTIFICATE-----
the certificate authority of your broker
-----END CERTIFICATE-----
)";
constexpr char kBoardCertificate[] = "";
constexpr char kBoardKey[] = "";
static_assert((sizeof kBoardCertificate > 1) == (sizeof kBoardKey > 1), "a certificate goes with its key");
#endif

}  // namespace arboleda
