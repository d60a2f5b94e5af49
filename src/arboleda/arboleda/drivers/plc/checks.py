"""What every mapping of a PLC has to keep: names of its kind, answers to questions, states, a way to stop."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from arboleda.kinds.declared import Device, DeviceVerb, Effect, FactType
from arboleda.model.outside import among
from arboleda.model.plant_model import Evidence

from .plc_snapshot import STATES

Place = tuple[str | int, ...]
Problem = tuple[Place, str]


def facts(mapped: Collection[str], device: Device, hint: str) -> Iterator[Problem]:
    """Facts that the kind does not have, and those that are not mapped."""
    yield from _names("fact", mapped, device.kind.facts, device, hint)


def verbs(mapped: Collection[str], device: Device, hint: str) -> Iterator[Problem]:
    """Verbs that the kind does not have, and those that are not mapped."""
    yield from _names("verb", mapped, device.kind.verbs, device, hint)


def _names(
    what: str, mapped: Collection[str], known: Collection[str], device: Device, hint: str
) -> Iterator[Problem]:
    key = f"{what}s"
    for name in mapped:
        if name not in known:
            yield (key, name), f"a {device.kind.name} has no {what} {name}; {among(name, known)}"
    for name in known:
        if name not in mapped:
            yield (key,), f"{name} of a {device.kind.name} is missing: {hint}"


def answer(place: Place, verb: DeviceVerb, hint: str, *, mapped: bool) -> Iterator[Problem]:
    """Whether a question has an answer, and nothing else has one."""
    if verb.effect is Effect.QUERY and not mapped:
        yield place, f"{verb.name} is a query: {hint}"
    if verb.effect is not Effect.QUERY and mapped:
        yield (*place, "answer"), f"{verb.name} is no query and has no answer"


def answers(verb: DeviceVerb) -> FactType:
    """What a question can be answered with."""
    first = verb.answers[0]
    return FactType(type=type(first), words=verb.answers, first=first)


def proof(device: Device, who: str, *, sequence: bool) -> Iterator[Problem]:
    """Whether the evidence of the device can be had without a sequence."""
    if device.evidence is Evidence.IDS and not sequence:
        yield (), f"evidence: ids needs sequence, numbers that {who} echoes; without, say evidence: facts"


def ways(device: Device, form: str, hint: str, *, state: bool, halt: bool) -> Iterator[Problem]:
    """What moves has to show that it does, and has to be stopped."""
    if device.works and not state:
        yield (), f"state is missing: without it nobody knows whether the device moves; {form}"
    if device.works and device.has_stop and not halt:
        yield (), f"halt is missing: say {hint} a motion, or say stop: none of the device"


def states(words: Collection[str]) -> Iterator[Problem]:
    """Whether the words for states are states, and enough of them."""
    for word in words:
        if word not in STATES:
            yield ("state", "words", word), f"there is no state {word}; {among(word, STATES)}"
    missing = [word for word in ("stopped", "moving") if word not in words]
    if missing:
        yield ("state",), f"has no number for {' and '.join(missing)}: words: {{stopped: 0, moving: 1}}"
