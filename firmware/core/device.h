// What a board knows of a device of a declared kind, and of how it is wired: constants that
// `arboleda firmware-config` writes. Angles are degrees, pulses and times are microseconds.
#pragma once

#include <stdint.h>

#include "list.h"

namespace arboleda {

constexpr uint8_t kMostFacts = 16;
constexpr uint8_t kMostValues = 6;  // of one verb
constexpr uint8_t kMostInputs = 16;
constexpr uint8_t kMostOutputs = 16;
constexpr uint8_t kMostServos = 4;
constexpr uint8_t kMostAnalogs = 4;
constexpr int8_t kAbsent = -1;

// A digital input, or the comparator of an analog one.
struct InputWiring {
    const char* name;
    int8_t pin;
    bool active_low;
    uint32_t debounce_us;    // it counts once it has been the same for so long
    int8_t analog = kAbsent;   // its comparator: on above the one, off below the other, else as it was
    double on_above = 0.0;
    double off_below = 0.0;
};

struct OutputWiring {
    const char* name;
    int8_t pin;
    bool active_low;
    bool safe_on;             // how it is after power-up, and where `safe_on_stop`, after `paro` 1
    bool safe_on_stop;
};

struct ServoWiring {
    const char* name;
    int8_t pin;
    double least_deg;
    double most_deg;
    uint16_t least_us;  // the pulse at `least_deg`
    uint16_t most_us;
    double deg_s;
};

struct AnalogWiring {
    const char* name;
    int8_t pin;
    double offset;  // value = offset + raw * per_count
    double per_count;
    double step;  // what is said is rounded to that
    uint16_t broken_below;
    uint16_t broken_above;
};

enum class ValueType : uint8_t { kBool, kWhole, kNumber, kText };

struct Choice {
    const char* text;  // a word; null: a number
    double number;
};

// What a value can be: one of some choices, or anything of its type within its limits.
struct ValueSpec {
    ValueType type;
    List<Choice> choices;
    double least;
    double most;
};

// Values are numbers in here: 0 and 1 of a bool, the place of a choice in its list, a number as it is.
struct Given {
    double constant;
    int8_t parameter = kAbsent;     // the value that came with the order, in its place
    const double* map = nullptr;  // for each value of that parameter
};

struct Condition {
    uint8_t input;
    bool on;
};

struct Row {
    double value;
    List<Condition> when;  // all of them
};

// What inputs say: the value of the one row that fits.
struct Reading {
    List<Row> rows;
    bool has_otherwise;
    double otherwise;  // where none fits
};

enum class Source : uint8_t {
    kTold,    // no input looks: what the last verb has set
    kInputs,
    kAnalog,
};

struct FactSpec {
    const char* name;
    ValueSpec type;
    Source source;
    Reading reading;
    uint8_t analog;
    double first;
};

struct Parameter {
    const char* name;
    ValueSpec type;
};

struct Setting {
    uint8_t fact;
    Given value;
};

struct Need {
    uint8_t fact;
    double value;
};

enum class Drive : uint8_t { kOutput, kServo };

struct Action {
    Drive drive;
    uint8_t index;
    Given value;
};

enum class Effect : uint8_t { kMotion, kProcess, kSwitch, kQuery };

struct VerbSpec {
    const char* name;
    Effect effect;
    List<Parameter> parameters;
    List<Setting> sets;
    List<Need> needs;
    List<Action> start;
    List<Action> end;      // whatever ended it
    List<Choice> answers;  // to a query
    ValueType answer_type;
    Reading answer;
    uint64_t least_us;  // it is not over before, whatever inputs say
    uint64_t most_us;   // then it is given up
    uint64_t takes_us;  // as the kind says: for a device that is not there
    bool finishes;      // goes on through a stop
    int8_t held_fact;   // of what takes hold of a part and lets go of it: the fact that says so
};

struct Device {
    List<FactSpec> facts;
    List<VerbSpec> verbs;
    List<InputWiring> inputs;
    List<OutputWiring> outputs;
    List<ServoWiring> servos;
    List<AnalogWiring> analogs;
};

inline bool is_work(const VerbSpec& verb) {
    return verb.effect == Effect::kMotion || verb.effect == Effect::kProcess;
}

inline double given(const Given& value, const double* values) {
    if (value.parameter == kAbsent) {
        return value.constant;
    }
    const double told = values[value.parameter];
    return value.map == nullptr ? told : value.map[static_cast<uint8_t>(told)];
}

}  // namespace arboleda
