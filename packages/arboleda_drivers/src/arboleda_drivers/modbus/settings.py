"""Settings of a device behind Modbus in a plant file: its keys, checked against the device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

from arboleda.drivers import Device, DeviceVerb, Effect, FactType, Robot, among
from arboleda_drivers.plc import checks
from arboleda_drivers.plc.checks import Place, Problem

from .keys import ModbusKeys, Verb
from .machine import readings
from .registers import Register, Write


@dataclass(frozen=True, kw_only=True)
class Settings(ModbusKeys):
    """Settings of the driver `modbus`: the connection, and the mapping of one device."""

    def problems(self, device: Robot) -> Iterator[Problem]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Device):
            yield from checks.undeclared(device)
            return
        yield from _facts(self, device)
        yield from _verbs(self, device)
        yield from _ways(self, device)
        yield from _overlaps(self)


def _facts(keys: ModbusKeys, device: Device) -> Iterator[Problem]:
    known = device.kind.facts
    yield from checks.facts(keys.facts, device, "say where the PLC shows it")
    for name, register in keys.facts.items():
        if name in known:
            yield from _fits(("facts", name), register, known[name])


def _verbs(keys: ModbusKeys, device: Device) -> Iterator[Problem]:
    known = device.kind.verbs
    yield from checks.verbs(keys.verbs, device, "say what is written for it")
    for name, verb in keys.verbs.items():
        if name in known:
            yield from _verb(("verbs", name), verb, known[name])


def _verb(place: Place, mapped: Verb, verb: DeviceVerb) -> Iterator[Problem]:
    for at, write in enumerate(mapped.write):
        yield from _written((*place, "write", at, "value"), write, verb)
    yield from _answers(place, mapped.answer, verb)
    if not mapped.write:
        yield place, f"nothing is written for {verb.name}, so the PLC cannot know what is asked"


def _written(place: Place, write: Write, verb: DeviceVerb) -> Iterator[Problem]:
    types = dict(verb.parameters)
    if write.parameter is None:
        return
    if write.parameter not in types:
        yield place, f"{verb.name} has no parameter {write.parameter}; {among(write.parameter, types)}"
        return
    yield from _fits(place, write, types[write.parameter])


def _answers(place: Place, answer: Register | None, verb: DeviceVerb) -> Iterator[Problem]:
    hint = "say where the PLC shows its answer, answer: {input: 20}"
    yield from checks.answer(place, verb, hint, mapped=answer is not None)
    if answer is not None and verb.effect is Effect.QUERY:
        yield from _fits((*place, "answer"), answer, verb.answer_type)


def _fits(place: Place, register: Register, fact: FactType) -> Iterator[Problem]:
    """Problems of values of a fact, parameter or answer that this register cannot hold."""
    if fact.type is str:
        missing = [str(word) for word in fact.words if word not in register.words]
        if not fact.words:
            yield place, "is any text, which registers cannot hold; give it words"
        elif missing:
            yield place, f"has no number for {', '.join(missing)}; write words: {{{missing[0]}: 0}}"
        return
    if register.words:
        yield place, f"has words, and is {fact.allowed()}"
    elif register.is_bit and fact.type is not bool:
        yield place, f"{register} is one bit, and the value is {fact.allowed()}"
    elif fact.type is int and (register.scale % 1 or register.offset % 1):
        yield place, "is a whole number, which a scale or an offset with decimals cannot give"
    elif fact.type is not bool:
        low, high = register.limits()
        beyond = [value for value in fact.samples if not low <= float(value) <= high]
        if beyond:
            there = f"{register} ({register.type}); allowed: {low:g} to {high:g}"
            yield place, f"{beyond[0]} does not fit into {there}"


def _ways(keys: ModbusKeys, device: Device) -> Iterator[Problem]:
    """Problems of a mapping that lacks something which the device's effects or evidence need from the PLC."""
    sequence, state = keys.sequence, keys.state
    yield from checks.proof(device, "the PLC", sequence=sequence is not None)
    if sequence is not None and (sequence.write.table, sequence.write.type) != ("holding", "uint16"):
        yield ("sequence", "write"), "must be a holding register of type uint16"
    form, hint = "state: {input: 0, words: {stopped: 0, moving: 1}}", "what is written to end"
    yield from checks.ways(device, form, hint, state=state is not None, halt=bool(keys.halt))
    if state is not None:
        yield from checks.states(state.words)
    for key in ("halt", "latch", "clear"):
        for at, write in enumerate(getattr(keys, key)):
            if write.parameter is not None:
                yield (key, at, "value"), f"{key} has no parameters; write a number, true or false"


def _overlaps(keys: ModbusKeys) -> Iterator[Problem]:
    """Problems of values that share a register but are read from it in different ways."""
    for (one, first), (two, second) in combinations(readings(keys), 2):
        if first.table != second.table:
            continue
        low, high = sorted((first, second), key=lambda each: each.address)
        apart = low.address + low.length <= high.address
        same = first.address == second.address and first.form == second.form
        if not apart and not same:
            what = f"{second} is read as {second.type} here and as {first.type} in {'.'.join(map(str, one))}"
            yield two, f"{what}; one register holds one type"
