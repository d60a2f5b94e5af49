// What goes in and out of the board of the device that device_config.h describes.
#pragma once

#include "device_config.h"
#include "device_telemetry.h"
#include "order.h"

namespace arboleda {
namespace profile {

// An order, or else a stop or a beat.
struct Incoming {
    bool is_order = false;
    Message message;
    Order order;
};

using Outgoing = DeviceTelemetry;

constexpr const char* kUsualName = kDeviceName;
constexpr uint8_t kTopics = 3;

inline const char* topic(uint8_t at) {
    return at == 0 ? kOrderChannel : channel_name(at == 1 ? Channel::kStop : Channel::kBeat);
}

inline Incoming read(uint8_t topic, const uint8_t* bytes, size_t size, bool retained) {
    Incoming incoming;
    incoming.is_order = topic == 0;
    if (incoming.is_order) {
        incoming.order = decode_order(kDevice, bytes, size, retained);
    } else {
        incoming.message = decode(topic == 1 ? Channel::kStop : Channel::kBeat, bytes, size, retained, 0);
    }
    return incoming;
}

inline size_t write(const Outgoing& said, char* buffer, size_t capacity) {
    return encode(kDevice, said, buffer, capacity);
}

}  // namespace profile
}  // namespace arboleda
