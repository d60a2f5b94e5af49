// What a board hears: one value per message, checked whole before anything acts on it.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace arboleda {

constexpr uint8_t kMostAxes = 6;

enum class Channel : uint8_t { kJoints, kEffector, kStop, kHome, kBeat };

constexpr uint8_t kChannels = 5;

// The second level of a topic, `juntas`, ...
const char* channel_name(Channel channel);

enum class Stop : uint8_t { kClear = 0, kLatch = 1, kHalt = 2 };

struct MaybeNumber {
    bool known = false;
    uint32_t value = 0;
};

constexpr size_t kTokenBytes = 12;

// Which step of which task a command is, for the board to echo; empty where it has none.
struct Token {
    char text[kTokenBytes + 1] = "";
};

struct Message {
    Channel channel = Channel::kBeat;
    bool well_formed = false;  // else only `seq` and `epoch` count, as far as they could be read
    bool retained = false;
    MaybeNumber seq;
    MaybeNumber epoch;
    MaybeNumber heard;  // the board's last telemetry that who commands had heard; not of a stop or a beat
    Token token;        // neither of them has one
    double q_deg[kMostAxes] = {};
    bool on = false;
    Stop stop = Stop::kHalt;
};

class Object;

// `seq` and `epoca`; false, and neither of them, where one of them is there and none.
bool read_stamp(const Object& object, Message* message);

// `visto`; false where it is there and none.
bool read_heard(const Object& object, Message* message);

// `ficha`; false where it is there and none.
bool read_token(const Object& object, Message* message);

// The message that these bytes are for a board with so many axes; retained as the broker flagged it.
Message decode(Channel channel, const uint8_t* bytes, size_t size, bool retained, uint8_t axes);

}  // namespace arboleda
