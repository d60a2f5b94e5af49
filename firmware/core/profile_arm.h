// What goes in and out of the board of an arm.
#pragma once

#include "message.h"
#include "robot_scara.h"
#include "telemetry.h"

namespace arboleda {
namespace profile {

using Incoming = Message;
using Outgoing = Telemetry;

constexpr char kUsualName[] = "ra_1";
constexpr uint8_t kTopics = kChannels;

inline const char* topic(uint8_t at) { return channel_name(static_cast<Channel>(at)); }

inline Incoming read(uint8_t topic, const uint8_t* bytes, size_t size, bool retained) {
    return decode(static_cast<Channel>(topic), bytes, size, retained, kScara.axes);
}

inline size_t write(const Outgoing& said, char* buffer, size_t capacity) { return encode(said, buffer, capacity); }

}  // namespace profile
}  // namespace arboleda
