// Prints what the press of examples/press_board says and drives, order by order: the same on every machine.
#include <stdio.h>

#include "device_bench.h"

// Linked as C where there is no C++ library; nothing calls it.
extern "C" void __cxa_pure_virtual() {
    for (;;) {
    }
}

namespace {

using namespace arboleda;

constexpr uint64_t kMsUs = 1000;

DeviceBench bench;

void show(const char* what) {
    char payload[kMessageBytes + 1];
    payload[encode(kDevice, bench.last, payload, kMessageBytes)] = '\0';
    printf("%s: %u us, outputs %d%d%d, %d reports, %s\n", what, bench.world.pulse_us(0), bench.world.output(0),
           bench.world.output(1), bench.world.output(2), bench.told, payload);
}

void order(const char* text) {
    bench.order(text);
    show(text);
    for (int part = 0; part < 12; ++part) {
        bench.run(37 * kMsUs);
        show("on the way");
    }
    bench.run(2500 * kMsUs);
    show("then");
}

}  // namespace

int main() {
    show("power");
    order(R"({"verbo":"open","seq":1,"epoca":5})");
    order(R"({"verbo":"close","seq":2,"epoca":5})");
    order(R"({"verbo":"clamp","valores":{"on":true},"seq":3,"epoca":5})");
    order(R"({"verbo":"press","valores":{"program":2},"seq":4,"epoca":5})");
    order(R"({"verbo":"look","seq":5,"epoca":5})");
    order(R"({"verbo":"hammer","seq":6,"epoca":5})");
    for (uint16_t counts = 100; counts < 4000; counts = static_cast<uint16_t>(counts + 611)) {
        bench.world.set_counts(0, counts);
        bench.run(333 * kMsUs);
        show("counts");
    }
    bench.world.stuck = true;
    order(R"({"verbo":"relieve","seq":7,"epoca":5})");
    bench.send(Channel::kStop, R"({"paro":1,"seq":8,"epoca":5})");
    show("latched");
    return 0;
}
