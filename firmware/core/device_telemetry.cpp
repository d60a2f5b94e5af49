#include "device_telemetry.h"

#include "writer.h"

namespace arboleda {

namespace {

void write(Writer& writer, const char* key, ValueType type, double value) {
    if (type == ValueType::kBool) {
        writer.boolean(key, value != 0.0);
    } else if (type == ValueType::kWhole) {
        writer.whole(key, value);
    } else {
        writer.angle(key, value);
    }
}

void write(Writer& writer, const char* key, ValueType type, const Choice& choice) {
    if (choice.text != nullptr) {
        writer.word(key, choice.text);
    } else {
        write(writer, key, type, choice.number);
    }
}

void answer(Writer& writer, const Device& device, const Answer& answer) {
    if (answer.seq.known) {
        const Choice& choice = device.verbs[answer.verb].answers[answer.choice];
        write(writer, "respuesta", device.verbs[answer.verb].answer_type, choice);
        writer.integer("respuesta_seq", answer.seq.value);
    }
}

void failures(Writer& writer, const OrderReceipts& receipts) {
    if (receipts.failures() == 0) {
        return;
    }
    writer.open("fallos", '[');
    for (uint8_t at = 0; at < receipts.failures(); ++at) {
        writer.pair(receipts.failure(at).seq, receipts.failure(at).word);
    }
    writer.close(']');
}

void facts(Writer& writer, const Device& device, const double* values) {
    writer.open("datos", '{');
    for (uint8_t at = 0; at < device.facts.count; ++at) {
        const FactSpec& fact = device.facts[at];
        if (fact.type.choices.count > 0) {
            write(writer, fact.name, fact.type.type, fact.type.choices[static_cast<uint8_t>(values[at])]);
        } else {
            write(writer, fact.name, fact.type.type, values[at]);
        }
    }
    writer.close('}');
}

size_t encode(const Device& device, const DeviceTelemetry& said, bool tokens, char* buffer, size_t capacity) {
    Writer writer(buffer, capacity);
    writer.integer("estado", static_cast<uint32_t>(said.state));
    writer.integer("seq", said.number);
    write_receipts(writer, said.receipts.numbers(), tokens);
    writer.integer("arranque", said.boot_id);
    answer(writer, device, said.receipts.answer());
    failures(writer, said.receipts);
    facts(writer, device, said.facts);
    return writer.finish();
}

}  // namespace

// A device that says much has room for all but the tokens.
size_t encode(const Device& device, const DeviceTelemetry& said, char* buffer, size_t capacity) {
    const size_t size = encode(device, said, true, buffer, capacity);
    return size > 0 ? size : encode(device, said, false, buffer, capacity);
}

}  // namespace arboleda
