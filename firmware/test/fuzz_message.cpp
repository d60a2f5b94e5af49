// libFuzzer: any bytes on any channel; what is well-formed must be within the bounds that the rest relies on.
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "../core/decimal.h"
#include "../core/message.h"
#include "../core/writer.h"

namespace {

using namespace arboleda;

void demand(bool truth) {
    if (!truth) {
        abort();
    }
}

void check(const Message& message, uint8_t axes) {
    char buffer[64];
    demand(message.channel == Channel::kBeat || message.seq.known == message.epoch.known);
    for (uint8_t axis = 0; axis < axes; ++axis) {
        demand(fabs(message.q_deg[axis]) <= kMaxAngleDeg);
        Writer writer(buffer, sizeof buffer);
        writer.angle("q", message.q_deg[axis]);
        demand(writer.finish() > 0);
    }
    demand(static_cast<uint8_t>(message.stop) <= 2);
    demand(!message.heard.known || (message.channel != Channel::kStop && message.channel != Channel::kBeat));
}

}  // namespace

// The first byte chooses channel and axes.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0) {
        return 0;
    }
    const auto channel = static_cast<Channel>(data[0] % kChannels);
    const uint8_t axes = data[0] >= 128 ? 6 : 3;
    const Message message = decode(channel, data + 1, size - 1, false, axes);
    if (message.well_formed) {
        check(message, axes);
    }
    return 0;
}
