#include "message.h"

#include "decimal.h"
#include "json.h"
#include "unicode.h"

namespace arboleda {

namespace {

constexpr const char* kJointKeys[kMostAxes] = {"q1", "q2", "q3", "q4", "q5", "q6"};
constexpr const char* kChannelNames[kChannels] = {"juntas", "efector", "paro", "referencia", "latido"};

bool integer(const Object& object, const char* key, uint32_t top, uint32_t* number) {
    Value value;
    return object.find(key, &value) && value.kind == Kind::kInteger && whole(value.text, top, number);
}

bool angle(const Object& object, const char* key, double* degrees) {
    Value value;
    const bool number = object.find(key, &value) && (value.kind == Kind::kInteger || value.kind == Kind::kReal);
    return number && real(value.text, kMaxAngleDeg, degrees);
}

// An integer that may be absent; false where it is there and none.
bool optional(const Object& object, const char* key, MaybeNumber* number) {
    number->known = object.has(key);
    return !number->known || integer(object, key, UINT32_MAX, &number->value);
}

bool joints(const Object& object, uint8_t axes, Message* message) {
    for (uint8_t axis = 0; axis < axes; ++axis) {
        if (!angle(object, kJointKeys[axis], &message->q_deg[axis])) {
            return false;
        }
    }
    return true;
}

bool body(const Object& object, uint8_t axes, Message* message) {
    uint32_t number = 0;
    switch (message->channel) {
        case Channel::kJoints:
            return joints(object, axes, message);
        case Channel::kEffector:
            message->on = integer(object, "efector", 1, &number) && number == 1;
            return integer(object, "efector", 1, &number);
        case Channel::kStop:
            if (!integer(object, "paro", 2, &number)) {
                return false;
            }
            message->stop = static_cast<Stop>(number);
            return true;
        case Channel::kHome:
            return integer(object, "ref", 1, &number) && number == 1;
        default:
            return message->epoch.known;
    }
}

bool stamped_well(const Message& message) {
    return message.channel == Channel::kBeat || message.seq.known == message.epoch.known;
}

// A stop is never too late nor of a step, and a beat is no command: whatever stands there is not for them.
bool may_be_late(Channel channel) { return channel != Channel::kStop && channel != Channel::kBeat; }

}  // namespace

bool read_stamp(const Object& object, Message* message) {
    if (optional(object, "seq", &message->seq) && optional(object, "epoca", &message->epoch)) {
        return true;
    }
    message->seq = message->epoch = MaybeNumber();
    return false;
}

bool read_heard(const Object& object, Message* message) { return optional(object, "visto", &message->heard); }

bool read_token(const Object& object, Message* message) {
    Value value;
    if (!object.find("ficha", &value)) {
        return true;
    }
    if (value.kind != Kind::kWord || !is_name(value.text, kTokenBytes)) {
        return false;
    }
    copy_ascii(value.text, message->token.text);
    return true;
}

const char* channel_name(Channel channel) { return kChannelNames[static_cast<uint8_t>(channel)]; }

Message decode(Channel channel, const uint8_t* bytes, size_t size, bool retained, uint8_t axes) {
    Message message;
    message.channel = channel;
    message.retained = retained;
    Object object;
    if (!object.read(bytes, size)) {
        return message;
    }
    const bool seq = optional(object, "seq", &message.seq);
    const bool epoch = optional(object, "epoca", &message.epoch);
    if (!seq || !epoch) {
        // a beat has no seq: whatever stands there is a key of a newer sender
        message.well_formed = channel == Channel::kBeat && epoch && message.epoch.known;
        message.seq = message.epoch = MaybeNumber();
        message.epoch.known = message.well_formed && integer(object, "epoca", UINT32_MAX, &message.epoch.value);
        return message;
    }
    const bool labels = !may_be_late(channel) || (read_heard(object, &message) && read_token(object, &message));
    message.well_formed = stamped_well(message) && labels && body(object, axes, &message);
    return message;
}

}  // namespace arboleda
