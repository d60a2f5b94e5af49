#include "telemetry.h"

#include "writer.h"

namespace arboleda {

namespace {

constexpr const char* kKeys[kMostAxes] = {"q1_mov", "q2_mov", "q3_mov", "q4_mov", "q5_mov", "q6_mov"};

void maybe(Writer& writer, const char* key, MaybeNumber number) {
    if (number.known) {
        writer.integer(key, number.value);
    }
}

void maybe(Writer& writer, const char* key, const char* token) {
    if (token[0] != '\0') {
        writer.word(key, token);
    }
}

}  // namespace

void write_receipts(Writer& writer, const Receipts& receipts, bool tokens) {
    maybe(writer, "epoca_ack", receipts.epoch());
    if (receipts.least().known && !(receipts.epoch().known && receipts.epoch().value == receipts.least().value)) {
        writer.integer("epoca_min", receipts.least().value);
    }
    maybe(writer, "ack", receipts.accepted());
    maybe(writer, "hecho", receipts.finished());
    if (tokens) {
        maybe(writer, "ficha_ack", receipts.accepted_token());
        maybe(writer, "ficha_hecho", receipts.finished_token());
    }
    if (receipts.refusal() != Refusal::kNone) {
        writer.word("rechazo", refusal_word(receipts.refusal()));
        writer.integer("rechazo_seq", receipts.refused());
    }
}

namespace {

void ids(Writer& writer, const Telemetry& said) {
    writer.integer("seq", said.number);
    write_receipts(writer, said.receipts, true);
    writer.integer("arranque", said.boot_id);
    writer.integer("ref", said.homed ? 1 : 0);
    writer.integer("efector", said.effector ? 1 : 0);
    if (said.has_piece_sensor) {
        writer.integer("pieza", said.piece ? 1 : 0);
    }
}

}  // namespace

size_t encode(const Telemetry& said, char* buffer, size_t capacity) {
    Writer writer(buffer, capacity);
    for (uint8_t axis = 0; axis < said.axes; ++axis) {
        writer.angle(kKeys[axis], said.q_deg[axis]);
    }
    writer.integer("estado", static_cast<uint32_t>(said.state));
    if (said.level == Level::kIds) {
        ids(writer, said);
    }
    return writer.finish();
}

}  // namespace arboleda
