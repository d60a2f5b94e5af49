"""The tables as constants of C++, one array after the other."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.drivers import Effect, FactType, OnStop, Value
from arboleda.wire import strict

from .shapes import AnalogShape, InputShape, OutputShape, ServoShape
from .tables import Action, Fact, Reading, Row, Tables, TableValue, Verb
from .values import encoded

HEAD = """\
// %(name)s, written by `arboleda firmware-config`; change its plant file or its wiring, not this.
#pragma once

#include "device.h"

namespace arboleda {

constexpr char kDeviceName[] = "%(name)s";

"""
TAIL = "\n}  // namespace arboleda\n"
TYPES = {bool: "kBool", int: "kWhole", float: "kNumber", str: "kText"}
EFFECTS = {
    Effect.MOTION: "kMotion",
    Effect.PROCESS: "kProcess",
    Effect.SWITCH: "kSwitch",
    Effect.QUERY: "kQuery",
}


def header(tables: Tables) -> str:
    """The whole header file."""
    return Header(tables).text()


class Header:
    """Collects arrays, each under a name of its own."""

    def __init__(self, tables: Tables) -> None:
        self._tables = tables
        self._arrays: list[str] = []

    def text(self) -> str:
        tables, wiring = self._tables, self._tables.wiring
        analogs = list(wiring.analogs)
        rows = (
            self._list("FactSpec", [self._fact(fact) for fact in tables.facts]),
            self._list("VerbSpec", [self._verb(verb) for verb in tables.verbs]),
            self._list("InputWiring", [_input(name, each, analogs) for name, each in wiring.inputs.items()]),
            self._list("OutputWiring", [_output(name, each) for name, each in wiring.outputs.items()]),
            self._list("ServoWiring", [_servo(name, each) for name, each in wiring.servos.items()]),
            self._list("AnalogWiring", [_analog(name, each) for name, each in wiring.analogs.items()]),
        )
        device = "constexpr Device kDevice = {" + ", ".join(rows) + "};\n"
        return HEAD % {"name": tables.name} + "\n".join([*self._arrays, "", device]) + TAIL

    def _array(self, type: str, items: Iterable[str]) -> str | None:
        """The name of an array; None for an empty one, which C++ does not have."""
        rows = list(items)
        if not rows:
            return None
        name = f"k{type[0].upper()}{type[1:]}s{len(self._arrays)}"
        self._arrays.append(f"constexpr {type} {name}[] = {{\n    " + ",\n    ".join(rows) + "};")
        return name

    def _list(self, type: str, items: Iterable[str]) -> str:
        name = self._array(type, items)
        return f"list({name})" if name else "{}"

    def _fact(self, fact: Fact) -> str:
        reading = self._reading(fact.reading)
        source = f"Source::{fact.source}, {reading}, {fact.analog}"
        first = encoded(fact.type, fact.type.first)
        return f"{{{_text(fact.name)}, {self._value(fact.type)}, {source}, {first!r}}}"

    def _value(self, type: FactType) -> str:
        limit = float(strict.UINT32) if type.type is int else strict.LARGEST
        least, most = (float(type.lower), float(type.upper)) if type.is_limited else (-limit, limit)
        return f"{{ValueType::{TYPES[type.type]}, {self._choices(type.words)}, {least!r}, {most!r}}}"

    def _choices(self, words: tuple[Value, ...]) -> str:
        return self._list("Choice", [_choice(word) for word in words])

    def _reading(self, reading: Reading) -> str:
        rows = self._list("Row", [self._row(row) for row in reading.rows])
        return f"{{{rows}, {_bool(reading.otherwise is not None)}, {reading.otherwise or 0.0!r}}}"

    def _row(self, row: Row) -> str:
        when = self._list("Condition", [f"{{{input}, {_bool(on)}}}" for input, on in row.when])
        return f"{{{row.value!r}, {when}}}"

    def _table_value(self, table: TableValue) -> str:
        name = self._array("double", [repr(value) for value in table.map]) or "nullptr"
        return f"{{{table.constant!r}, {table.parameter}, {name}}}"

    def _actions(self, actions: tuple[Action, ...]) -> str:
        rows = [f"{{Drive::{each.drive}, {each.index}, {self._table_value(each.value)}}}" for each in actions]
        return self._list("Action", rows)

    def _verb(self, verb: Verb) -> str:
        declared = verb.declared
        parameters = [f"{{{_text(name)}, {self._value(type)}}}" for name, type in declared.parameters]
        answer_type = TYPES[declared.answer_type.type] if declared.effect is Effect.QUERY else "kText"
        fields = (
            _text(declared.name),
            f"Effect::{EFFECTS[declared.effect]}",
            self._list("Parameter", parameters),
            self._list("Setting", [f"{{{fact}, {self._table_value(table)}}}" for fact, table in verb.sets]),
            self._list("Need", [f"{{{fact}, {value!r}}}" for fact, value in verb.needs]),
            self._actions(verb.start),
            self._actions(verb.end),
            self._choices(declared.answers),
            f"ValueType::{answer_type}",
            self._reading(verb.answer),
            _us(verb.at_least_s),
            _us(declared.at_most_s),
            _us(declared.takes_s),
            _bool(declared.on_stop is OnStop.FINISH),
            str(verb.held_fact),
        )
        return "{" + ", ".join(fields) + "}"


def _input(name: str, each: InputShape, analogs: list[str]) -> str:
    analog = analogs.index(each.analog) if each.analog is not None else -1
    pin = -1 if each.pin is None else each.pin
    limits = f"{each.on_above or 0.0!r}, {each.off_below or 0.0!r}"
    low = _bool(each.active == "low" and each.analog is None)
    return f"{{{_text(name)}, {pin}, {low}, {each.debounce_ms * 1000}, {analog}, {limits}}}"


def _output(name: str, each: OutputShape) -> str:
    bits = (each.active == "low", each.safe == "on", each.on_stop == "safe")
    return f"{{{_text(name)}, {each.pin}, {', '.join(map(_bool, bits))}}}"


def _servo(name: str, each: ServoShape) -> str:
    degrees = ", ".join(repr(float(angle)) for angle in each.degrees)
    pulses = ", ".join(map(str, each.pulse_us))
    return f"{{{_text(name)}, {each.pin}, {degrees}, {pulses}, {float(each.deg_s)!r}}}"


def _analog(name: str, each: AnalogShape) -> str:
    per_count = (each.means[1] - each.means[0]) / (each.counts[1] - each.counts[0])
    offset = each.means[0] - each.counts[0] * per_count
    numbers = ", ".join(repr(float(number)) for number in (offset, per_count, each.step))
    return f"{{{_text(name)}, {each.pin}, {numbers}, {each.broken[0]}, {each.broken[1]}}}"


def _choice(word: Value) -> str:
    return f"{{{_text(word)}, 0.0}}" if isinstance(word, str) else f"{{nullptr, {float(word)!r}}}"


def _text(word: str) -> str:
    return f'"{word}"'


def _bool(truth: bool) -> str:
    return "true" if truth else "false"


def _us(seconds: float) -> str:
    return str(round(seconds * 1e6))
