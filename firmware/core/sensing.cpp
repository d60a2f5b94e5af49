#include "sensing.h"

namespace arboleda {

namespace {

constexpr double kSmoothing = 1.0 / 8.0;  // a time constant of 16 ms

double rounded(double value, double step) {
    const double steps = value / step;
    const auto whole = static_cast<int64_t>(steps < 0.0 ? steps - 0.5 : steps + 0.5);
    return static_cast<double>(whole) * step;
}

}  // namespace

Sensing::Sensing(const Device& device, DeviceHardware& hardware) : device_(device), hardware_(hardware) {}

void Sensing::begin(uint64_t now_us) {
    for (uint8_t at = 0; at < device_.analogs.count; ++at) {
        counts_[at] = hardware_.counts(at);
    }
    for (uint8_t at = 0; at < device_.inputs.count; ++at) {
        inputs_[at] = Debounced();
        inputs_[at].begin(now_us, sample(at));
    }
    sampled_us_ = sane_us_ = now_us;
    sane_ = true;
}

bool Sensing::poll(uint64_t now_us) {
    if (!looks() || now_us < next_us()) {
        return false;
    }
    sampled_us_ = now_us;
    for (uint8_t at = 0; at < device_.analogs.count; ++at) {
        counts_[at] += (hardware_.counts(at) - counts_[at]) * kSmoothing;
    }
    for (uint8_t at = 0; at < device_.inputs.count; ++at) {
        inputs_[at].see(now_us, sample(at), device_.inputs[at].debounce_us);
    }
    if (plausible()) {
        sane_us_ = now_us;
    }
    sane_ = now_us - sane_us_ < kDoubtUs && (sane_ || sane_us_ == now_us);
    return true;
}

double Sensing::value(uint8_t analog) const {
    const AnalogWiring& wiring = device_.analogs[analog];
    return rounded(wiring.offset + counts_[analog] * wiring.per_count, wiring.step);
}

bool Sensing::sample(uint8_t input) const {
    const InputWiring& wiring = device_.inputs[input];
    if (wiring.analog == kAbsent) {
        return hardware_.level(input) != wiring.active_low;
    }
    const AnalogWiring& analog = device_.analogs[static_cast<uint8_t>(wiring.analog)];
    const double value = analog.offset + counts_[wiring.analog] * analog.per_count;
    return inputs_[input].seen() ? value >= wiring.off_below : value > wiring.on_above;
}

// No analog input out of its range, no two words of one fact at once.
bool Sensing::plausible() const {
    for (uint8_t at = 0; at < device_.analogs.count; ++at) {
        const AnalogWiring& wiring = device_.analogs[at];
        if (counts_[at] < wiring.broken_below || counts_[at] > wiring.broken_above) {
            return false;
        }
    }
    for (const FactSpec& fact : device_.facts) {
        double value = 0.0;
        if (fact.source == Source::kInputs && !read(fact.reading, &value)) {
            return false;
        }
    }
    return true;
}

bool Sensing::read(const Reading& reading, double* value) const {
    uint8_t fitting = 0;
    for (const Row& row : reading.rows) {
        if (fits(row)) {
            *value = row.value;
            ++fitting;
        }
    }
    if (fitting == 0 && reading.has_otherwise) {
        *value = reading.otherwise;
        return true;
    }
    return fitting == 1;
}

bool Sensing::fits(const Row& row) const {
    for (const Condition& condition : row.when) {
        if (inputs_[condition.input].on() != condition.on) {
            return false;
        }
    }
    return true;
}

}  // namespace arboleda
