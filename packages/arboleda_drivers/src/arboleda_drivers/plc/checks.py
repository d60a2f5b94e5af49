"""Checks of every PLC mapping: names of its kind, answers to queries, states, a way to stop."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from difflib import get_close_matches

from arboleda.drivers import Device, DeviceVerb, Effect, Evidence, FactType, Robot, among

from .plc_snapshot import STATES
from .variables import FORMS, PlcArgument, PlcVariable

Place = tuple[str | int, ...]
Problem = tuple[Place, str]


def undeclared(robot: Robot) -> Iterator[Problem]:
    """The problem of a robot of no declared kind, for which nothing can be mapped."""
    yield (), f"reaches devices of declared kinds; {robot.name} is of the kind {robot.kind_name}"


def facts(mapped: Collection[str], device: Device, hint: str) -> Iterator[Problem]:
    """Problems of the mapped facts: unknown to the kind, or missing."""
    yield from _names("fact", mapped, device.kind.facts, device, hint)


def shown_facts(mapped: Mapping[str, PlcVariable], device: Device, hint: str) -> Iterator[Problem]:
    """Problems of the variables that show facts: of their names, and of their words."""
    yield from facts(mapped, device, hint)
    for name, variable in mapped.items():
        if name in device.kind.facts:
            yield from words(("facts", name), variable.words, device.kind.facts[name])


def verbs(mapped: Collection[str], device: Device, hint: str) -> Iterator[Problem]:
    """Problems of the mapped verbs: unknown to the kind, or missing."""
    yield from _names("verb", mapped, device.kind.verbs, device, hint)


def _names(
    what: str, mapped: Collection[str], known: Collection[str], device: Device, hint: str
) -> Iterator[Problem]:
    key, unknown = f"{what}s", [name for name in mapped if name not in known]
    for name in unknown:
        yield (key, name), f"a {device.kind.name} has no {what} {name}; {among(name, known)}"
    for name in known:
        if name not in mapped and not get_close_matches(name, unknown):  # else it is written wrong
            yield (key,), f"{name} of a {device.kind.name} is missing: {hint}"


def answer(place: Place, verb: DeviceVerb, hint: str, *, mapped: bool) -> Iterator[Problem]:
    """Problems of a query without an answer, and of an answer on any other verb."""
    if verb.effect is Effect.QUERY and not mapped:
        yield place, f"{verb.name} is a query: {hint}"
    if verb.effect is not Effect.QUERY and mapped:
        yield (*place, "answer"), f"{verb.name} is no query and has no answer"


def proof(device: Device, who: str, *, sequence: bool) -> Iterator[Problem]:
    """A problem if the device's evidence is ids and the mapping has no sequence."""
    if device.evidence is Evidence.IDS and not sequence:
        yield (), f"evidence: ids needs sequence, numbers that {who} echoes; without, say evidence: facts"


def ways(device: Device, form: str, hint: str, *, state: bool, halt: bool) -> Iterator[Problem]:
    """Problems of a device that moves: it must show that it does, and have a way to be stopped."""
    if device.works and not state:
        yield (), f"state is missing: without it nobody knows whether the device moves; {form}"
    if device.works and device.has_stop and not halt:
        yield (), f"halt is missing: say {hint} a motion, or say stop: none of the device"


def states(words: Collection[str]) -> Iterator[Problem]:
    """Problems of the words for states: each must be a state, and "stopped" and "moving" are needed."""
    unknown = [word for word in words if word not in STATES]
    for word in unknown:
        yield ("state", "words", word), f"there is no state {word}; {among(word, STATES)}"
    missing = [word for word in ("stopped", "moving") if word not in words]
    if missing and not unknown:  # else one of those is meant
        yield ("state",), f"has no number for {' and '.join(missing)}: words: {{stopped: 0, moving: 1}}"


def words(place: Place, mapped: Mapping[str, int], of: FactType) -> Iterator[Problem]:
    """Problems of the numbers of words: for a value that has no words, or without one of them."""
    missing = [str(word) for word in of.words if word not in mapped]
    if mapped and of.type is not str:
        yield place, f"has words, and is {of.allowed()}"
    elif mapped and missing:
        yield place, f"has no number for {', '.join(missing)}; write words: {{{missing[0]}: 0}}"
    elif mapped and not of.words:
        yield place, "has words, and is any text"


def argument(
    place: Place,
    given: PlcArgument,
    verb: DeviceVerb,
    *,
    key: str,
    names: Mapping[type, Sequence[str]] = FORMS,
) -> Iterator[Problem]:
    """Problems of a value that is sent for a verb; `key` is that of its type, `names` those of types."""
    types = dict(verb.parameters)
    if given.parameter is None:
        return
    if given.parameter not in types:
        what = f"{verb.name} has no parameter {given.parameter}"
        yield (*place, "value"), f"{what}; {among(given.parameter, types)}"
        return
    of = types[given.parameter]
    if given.words:
        yield from words(place, given.words, of)
    elif given.form not in FORMS[of.type]:
        yield (*place, key), f"the value is {of.allowed()}; allowed: {', '.join(names[of.type])}"
    else:
        beyond = [value for value in of.samples if not given.fits(value)]
        if beyond:
            yield place, f"{beyond[0]} is no {given.type_name}; write a type that holds {of.allowed()}"


def plain(place: Place, given: PlcArgument, what: str) -> Iterator[Problem]:
    """A problem if a value that is sent for a stop names a parameter."""
    if given.parameter is not None:
        yield (*place, "value"), f"{what} has no parameters; write a value"


def shown_answer(place: Place, shown: PlcVariable | None, verb: DeviceVerb, hint: str) -> Iterator[Problem]:
    """Problems of the variable that shows the answer to a query."""
    yield from answer(place, verb, hint, mapped=shown is not None)
    if shown is not None and verb.effect is Effect.QUERY:
        yield from words((*place, "answer"), shown.words, verb.answer_type)
