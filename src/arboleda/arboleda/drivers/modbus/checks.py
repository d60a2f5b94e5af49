"""Whether a mapping fits the kind of its device: each problem by its keys, with a sentence."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from arboleda.kinds.declared import Device, DeviceVerb, Effect, FactType
from arboleda.model.outside import among
from arboleda.model.plant_model import Evidence, Robot

from ..plc.shown import STATES
from .machine import readings
from .registers import Register, Write
from .settings import Settings

Place = tuple[str | int, ...]
Problem = tuple[Place, str]


def problems(settings: Settings, device: Robot) -> Iterator[Problem]:
    """All that is wrong with the mapping of this device."""
    if not isinstance(device, Device):
        yield (), f"reaches devices of declared kinds; {device.name} is of the kind {device.kind_name}"
        return
    yield from _facts(settings, device)
    yield from _verbs(settings, device)
    yield from _ways(settings, device)
    yield from _overlaps(settings)


def _facts(settings: Settings, device: Device) -> Iterator[Problem]:
    facts = device.kind.facts
    for name, register in settings.facts.items():
        if name not in facts:
            yield ("facts", name), f"a {device.kind.name} has no fact {name}; {among(name, facts)}"
        else:
            yield from _fits(("facts", name), register, facts[name])
    for name in facts:
        if name not in settings.facts:
            yield ("facts",), f"{name} of a {device.kind.name} is missing: say where the PLC shows it"


def _verbs(settings: Settings, device: Device) -> Iterator[Problem]:
    verbs = device.kind.verbs
    for name, verb in settings.verbs.items():
        if name not in verbs:
            yield ("verbs", name), f"a {device.kind.name} has no verb {name}; {among(name, verbs)}"
            continue
        for at, write in enumerate(verb.write):
            yield from _written(("verbs", name, "write", at, "value"), write, verbs[name])
        yield from _answers(("verbs", name), verb.answer, verbs[name])
        if not verb.write:
            yield ("verbs", name), f"nothing is written for {name}, so the PLC cannot know what is asked"
    for name in verbs:
        if name not in settings.verbs:
            yield ("verbs",), f"{name} of a {device.kind.name} is missing: say what is written for it"


def _written(place: Place, write: Write, verb: DeviceVerb) -> Iterator[Problem]:
    types = dict(verb.parameters)
    if write.parameter is None:
        return
    if write.parameter not in types:
        yield place, f"{verb.name} has no parameter {write.parameter}; {among(write.parameter, types)}"
        return
    yield from _fits(place, write, types[write.parameter])


def _answers(place: Place, answer: Register | None, verb: DeviceVerb) -> Iterator[Problem]:
    if verb.effect is not Effect.QUERY:
        if answer is not None:
            yield (*place, "answer"), f"{verb.name} is no query and has no answer"
    elif answer is None:
        yield place, f"{verb.name} is a query: say where the PLC shows its answer, answer: {{input: 20}}"
    else:
        first = verb.answers[0]
        of = FactType(type=type(first), words=verb.answers, first=first)
        yield from _fits((*place, "answer"), answer, of)


def _fits(place: Place, register: Register, fact: FactType) -> Iterator[Problem]:
    """Whether the values of a fact, a parameter or an answer can stand there."""
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


def _ways(settings: Settings, device: Device) -> Iterator[Problem]:
    """What the effects and the evidence of a device ask of its PLC."""
    if device.evidence is Evidence.IDS and settings.sequence is None:
        yield (), "evidence: ids needs sequence, numbers that the PLC echoes; without, say evidence: facts"
    written = None if settings.sequence is None else settings.sequence.write
    if written is not None and (written.table, written.type) != ("holding", "uint16"):
        yield ("sequence", "write"), "must be a holding register of type uint16"
    if settings.state is None and device.works:
        form = "state: {input: 0, words: {stopped: 0, moving: 1}}"
        yield (), f"state is missing: without it nobody knows whether the device moves; {form}"
    if settings.state is not None:
        yield from _states(settings.state)
    if device.works and device.has_stop and not settings.halt:
        yield (), "halt is missing: say what is written to end a motion, or say stop: none of the device"
    for key in ("halt", "latch", "clear"):
        for at, write in enumerate(getattr(settings, key)):
            if write.parameter is not None:
                yield (key, at, "value"), f"{key} has no parameters; write a number, true or false"


def _states(state: Register) -> Iterator[Problem]:
    for word in state.words:
        if word not in STATES:
            yield ("state", "words", word), f"there is no state {word}; {among(word, STATES)}"
    missing = [word for word in ("stopped", "moving") if word not in state.words]
    if missing:
        yield ("state",), f"has no number for {' and '.join(missing)}: words: {{stopped: 0, moving: 1}}"


def _overlaps(settings: Settings) -> Iterator[Problem]:
    """Two values may share a register only where both read it in the same way."""
    for (one, first), (two, second) in combinations(readings(settings), 2):
        if first.table != second.table:
            continue
        low, high = sorted((first, second), key=lambda each: each.address)
        apart = low.address + low.length <= high.address
        same = first.address == second.address and first.form == second.form
        if not apart and not same:
            what = f"{second} is read as {second.type} here and as {first.type} in {'.'.join(map(str, one))}"
            yield two, f"{what}; one register holds one type"
