#include "order.h"

#include "decimal.h"
#include "json.h"
#include "unicode.h"

namespace arboleda {

namespace {

constexpr size_t kLongest = 32;  // bytes of a name, and of a text
constexpr double kLargest = 1e9;
constexpr double kLargestWhole = UINT32_MAX;

Text plain(const char* zero_terminated) {
    Text text = {zero_terminated, 0};
    while (zero_terminated[text.size] != '\0') {
        ++text.size;
    }
    return text;
}

// Outside ASCII only the plant knows what can be printed.
bool in_text(uint32_t point) {
    const bool half = point >= 0xD800 && point <= 0xDFFF;  // of a pair, without the other
    return (point >= ' ' && point <= '~' && point != '"' && point != '\\') || (point > 0xA0 && !half);
}

bool number(const Value& value, double* read) {
    return real(value.text, kLargest * 8, read) &&
           (*read < 0 ? -*read : *read) <= (value.kind == Kind::kInteger ? kLargestWhole : kLargest);
}

// A value of any device: yes or no, a number, a short text.
bool is_value(const Value& value, double* read) {
    switch (value.kind) {
        case Kind::kTrue:
        case Kind::kFalse:
            *read = value.kind == Kind::kTrue ? 1.0 : 0.0;
            return true;
        case Kind::kWord:
            return consists_of(value.text, kLongest, in_text);
        case Kind::kInteger:
        case Kind::kReal:
            return number(value, read);
        default:
            return false;
    }
}

bool type_fits(ValueType type, Kind kind) {
    switch (type) {
        case ValueType::kBool:
            return kind == Kind::kTrue || kind == Kind::kFalse;
        case ValueType::kWhole:
            return kind == Kind::kInteger;
        case ValueType::kNumber:
            return kind == Kind::kInteger || kind == Kind::kReal;
        default:
            return kind == Kind::kWord;
    }
}

bool chosen(const List<Choice>& choices, const Value& value, double* read) {
    for (uint8_t at = 0; at < choices.count; ++at) {
        const Choice& choice = choices[at];
        if (choice.text != nullptr ? same_text(value.text, plain(choice.text)) : *read == choice.number) {
            *read = at;
            return true;
        }
    }
    return false;
}

// The value as one of this type, where it is one.
bool takes(const ValueSpec& spec, const Value& value, double* read) {
    if (!type_fits(spec.type, value.kind)) {
        return false;
    }
    if (spec.choices.count > 0) {
        return chosen(spec.choices, value, read);
    }
    const bool measured = spec.type == ValueType::kWhole || spec.type == ValueType::kNumber;
    return !measured || (spec.least <= *read && *read <= spec.most);
}

class Reader {
public:
    Reader(const Device& device, const Object& object, Order* order)
        : device_(device), object_(object), order_(*order) {}

    // False: no device would take it.
    bool read() {
        Value verb;
        if (!object_.find("verbo", &verb) || verb.kind != Kind::kWord || !is_name(verb.text, kLongest)) {
            return false;
        }
        order_.known = find_verb(verb.text);
        Value values;
        if (!object_.find("valores", &values)) {
            order_.known = order_.known && spec().parameters.count == 0;
            return true;
        }
        return values.kind == Kind::kObject && read_values(values.text);
    }

private:
    const VerbSpec& spec() const { return device_.verbs[order_.verb]; }

    bool find_verb(Text name) {
        for (uint8_t verb = 0; verb < device_.verbs.count; ++verb) {
            if (same_text(name, plain(device_.verbs[verb].name))) {
                order_.verb = verb;
                return true;
            }
        }
        return false;
    }

    bool read_values(Text text) {
        Object inner;
        if (!inner.read(reinterpret_cast<const uint8_t*>(text.at), text.size)) {
            return false;
        }
        for (size_t at = 0; at < inner.count(); ++at) {
            double number = 0.0;
            if (!is_name(inner.key(at), kLongest) || !is_value(inner.value(at), &number)) {
                return false;
            }
        }
        order_.known = order_.known && take_values(inner);
        return true;
    }

    bool take_values(const Object& inner) {
        if (inner.count() != spec().parameters.count) {
            return false;
        }
        for (uint8_t at = 0; at < spec().parameters.count; ++at) {
            const Parameter& parameter = spec().parameters[at];
            Value value;
            double read = 0.0;
            if (!inner.find(parameter.name, &value) || !is_value(value, &read) ||
                !takes(parameter.type, value, &read)) {
                return false;
            }
            order_.values[at] = parameter.type.type == ValueType::kText && parameter.type.choices.count == 0 ? 0.0 : read;
        }
        return true;
    }

    const Device& device_;
    const Object& object_;
    Order& order_;
};

}  // namespace

Order decode_order(const Device& device, const uint8_t* bytes, size_t size, bool retained) {
    Order order;
    order.head.channel = Channel::kJoints;  // no channel of its own: nobody asks it of an order
    order.head.retained = retained;
    Object object;
    if (!object.read(bytes, size) || !read_stamp(object, &order.head)) {
        return order;
    }
    const bool stamped = order.head.seq.known == order.head.epoch.known;
    order.head.well_formed = stamped && read_heard(object, &order.head) && read_token(object, &order.head) &&
                             Reader(device, object, &order).read();
    order.known = order.known && order.head.well_formed;
    return order;
}

}  // namespace arboleda
