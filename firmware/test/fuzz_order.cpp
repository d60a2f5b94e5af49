// libFuzzer: any bytes as an order to the press; what is taken must be within the bounds that the rest relies on.
#include <stdlib.h>

#include "device_bench.h"

namespace {

using namespace arboleda;

void demand(bool truth) {
    if (!truth) {
        abort();
    }
}

void check(const Order& order) {
    demand(order.head.seq.known == order.head.epoch.known);
    demand(order.verb < kDevice.verbs.count);
    const VerbSpec& verb = kDevice.verbs[order.verb];
    for (uint8_t at = 0; order.known && at < verb.parameters.count; ++at) {
        const ValueSpec& type = verb.parameters[at].type;
        const double value = order.values[at];
        demand(type.choices.count == 0 || (value >= 0.0 && value < type.choices.count));
        demand(type.type != ValueType::kBool || value == 0.0 || value == 1.0);
    }
}

}  // namespace

// The whole board hears it, after what it needs; a known order has to leave it in a state that can be told.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const Order order = decode_order(kDevice, data, size, false);
    if (!order.head.well_formed) {
        return 0;
    }
    check(order);
    DeviceBench bench;
    bench.order(R"({"verbo":"clamp","valores":{"on":true},"seq":1,"epoca":1})");
    bench.run(500000);
    bench.board.receive(bench.now_us, order);
    bench.run(3000000);
    char buffer[kMessageBytes];
    demand(encode(kDevice, bench.last, buffer, sizeof buffer) > 0);
    return 0;
}
