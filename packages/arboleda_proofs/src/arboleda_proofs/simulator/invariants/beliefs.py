"""Invariants of the plant's beliefs: the last word of each robot, and its presence while it speaks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import attrgetter
from typing import Any

from arboleda.drivers import Device, Evidence, Robot, Value
from arboleda.engine.inspection import beliefs_of

from ..recorded.scopes import UNSENT
from .invariant import Look, Trigger, invariant

EVERY_S = 2.0
FIELDS = ("state", "homed", "effector", "piece", "boot_id", "epoch", "plant", "q", "node")
_believed = attrgetter(*FIELDS)
_values = attrgetter(*("boot" if field == "boot_id" else field for field in FIELDS))


@invariant(Trigger.SAID, every_s=EVERY_S)
def believed_as_said(look: Look) -> Iterable[str]:
    """The plant believes the last word of each robot on everything, and that who is silent is not there."""
    record = look.record
    return _unlike(look, set(record.robots) if look.whole else {report.robot for report in record.heard.anew})


def _unlike(look: Look, robots: set[str]) -> Iterator[str]:
    for name in robots & look.record.robots.keys():
        known, belief = look.record.robots[name], beliefs_of(look.world.plant)[name]
        if known.robot.link in UNSENT:
            continue
        if (believed := _believed(belief)) != (said := _values(known)):
            for field, taken, word in zip(FIELDS, believed, said, strict=True):
                if taken != word:
                    yield f"{name}: its {field} is taken for {taken}, its word was {word}"
        if belief.facts != known.facts:
            yield f"{name}: its facts are taken for {belief.facts}, its word was {known.facts}"
        if beyond := BEYOND.get(type(known.robot)):
            yield from beyond(known.robot, belief.facts)
        offline = known.offline(look.world.plant.now)
        if belief.online is offline:
            yield f"{name} is {'' if belief.online else 'not '}online by what the plant believes"
        if known.robot.evidence is Evidence.IDS and belief.unhomed is not known.unhomed:
            yield f"{name} is {'not ' if belief.unhomed else ''}homed by what the plant believes"


def _beyond(device: Device, facts: Mapping[str, Value]) -> Iterator[str]:
    """Sentences on facts that are none of the values of their kind."""
    for fact, value in facts.items():
        type = device.kind.facts[fact]
        unknown = type.words and value not in type.words
        if unknown or (isinstance(value, int | float) and not type.lower <= value <= type.upper):
            yield f"{device.name}: {fact} is taken for {value}, which a {device.kind.name} cannot say"


Objections = Callable[[Any, Mapping[str, Value]], Iterator[str]]
BEYOND: Mapping[type[Robot], Objections] = {Device: _beyond}  # of the robots whose facts have types
BELIEFS = (believed_as_said,)
