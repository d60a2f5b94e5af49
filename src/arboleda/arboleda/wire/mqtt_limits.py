"""Checks that a kind of device can be used over MQTT: its names, and the longest of its messages."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, FactType
from arboleda.model.errors import PayloadError
from arboleda.model.facts import Value
from arboleda.model.messages import MotionState

from . import strict
from .payloads import DEVICE_REFUSALS, MOST_FAILURES, Telemetry, VerbGoal, encode
from .strict import LONGEST, LONGEST_WORD, UINT32

SMALLEST = -2.2250738585072014e-300  # no number takes more characters
TEXT = "x" * LONGEST


Place = tuple[str | int, ...]
"""Keys of a kind in a plant file, down to the index of a word in a list."""


@dataclass(frozen=True, kw_only=True)
class Objection:
    """Reason why a kind of device cannot be used over MQTT, and the place of the fault in the kind."""

    place: Place
    sentence: str


def objections(kind: DeviceKind) -> list[Objection]:
    """All objections to a kind of device over MQTT."""
    first = [*_names(kind), *_silent(kind)]
    return first or [*_lengths(kind)]


def _names(kind: DeviceKind) -> Iterator[Objection]:
    for name, type in kind.facts.items():
        place: Place = ("facts", name)
        yield from _refused(place, f"a fact of {kind.name}", strict.name, "its name", name)
        yield from _values(place, f"{name} of {kind.name}", type.words)
    for verb in kind.verbs.values():
        place = ("verbs", verb.name)
        yield from _refused(place, f"a verb of {kind.name}", strict.name, "its name", verb.name)
        for name, type in verb.parameters:
            whose = f"a value of {verb.name} of {kind.name}"
            yield from _refused((*place, "with", name), whose, strict.name, "its name", name)
            yield from _values((*place, "with", name), f"{name} of {verb.name} of {kind.name}", type.words)
        yield from _values((*place, "answers"), f"an answer to {verb.name} of {kind.name}", verb.answers)


def _values(place: Place, whose: str, values: tuple[Value, ...]) -> Iterator[Objection]:
    for index, value in enumerate(values):
        yield from _refused((*place, index), whose, strict.shown_fact, "it", value)


def _silent(kind: DeviceKind) -> Iterator[Objection]:
    for verb in kind.verbs.values():
        if verb.effect is Effect.SWITCH and not verb.sets_facts:
            what = f"{verb.name} of {kind.name} is a switch that sets no fact"
            sentence = f"{what}: nothing would say that it is done"
            yield Objection(place=("verbs", verb.name), sentence=sentence)


def _lengths(kind: DeviceKind) -> Iterator[Objection]:
    for verb in kind.verbs.values():
        goal = VerbGoal(
            verb=verb.name,
            values=tuple((name, longest(type)) for name, type in verb.parameters),
            seq=UINT32,
            epoch=UINT32,
            heard=UINT32,
        )
        whose = f"{verb.name} of {kind.name} with its longest values"
        yield from _refused(("verbs", verb.name), whose, encode, goal)
    yield from _refused((), f"all that a {kind.name} can say at once", encode, _telemetry(kind))


def _telemetry(kind: DeviceKind) -> Telemetry:
    """The longest telemetry that a device of this kind can send."""
    answers = [answer for verb in kind.verbs.values() for answer in _answers(verb)]
    return Telemetry(
        q_deg=None,
        node=None,
        state=MotionState.STOP_LATCHED,
        seq=UINT32,
        ack_epoch=UINT32,
        least_epoch=UINT32,
        ack=UINT32,
        done=UINT32,
        refusal=max(DEVICE_REFUSALS, key=len),
        refused_seq=UINT32,
        boot_id=UINT32,
        facts=tuple((name, longest(type)) for name, type in kind.facts.items()),
        answer=max(answers, key=_length, default=None),
        answered_seq=UINT32 if answers else None,
        failures=((UINT32, "x" * LONGEST_WORD),) * MOST_FAILURES,
    )


def _answers(verb: DeviceVerb) -> tuple[Value, ...]:
    return (verb.answers or (TEXT,)) if verb.effect is Effect.QUERY else ()


def longest(type: FactType) -> Value:
    """The value of a type that takes most bytes."""
    return max(type.words or (LONGEST_OF[type.type],), key=_length)


def _length(value: Value) -> int:
    return len(strict.to_json(value).encode())


def _refused(
    place: Place, whose: str, look: Callable[..., object], *arguments: object
) -> Iterator[Objection]:
    try:
        look(*arguments)
    except PayloadError as error:
        yield Objection(place=place, sentence=f"{whose}: {error}")


LONGEST_OF: dict[type, Value] = {bool: False, int: -UINT32, float: SMALLEST, str: TEXT}
