"""Invariants of the plant's beliefs: the last word of each robot, and its presence while it speaks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.model.plant_model import Evidence

from ..recorded.scopes import UNSENT
from .invariant import Look, Trigger, invariant

NOTHING: tuple[str, ...] = ()
EVERY_S = 2.0
FIELDS = ("state", "homed", "effector", "piece", "boot_id", "epoch", "plant", "q", "node")


@invariant(Trigger.STEPPED)
def believed_as_said(look: Look) -> Iterable[str]:
    """The plant believes the last word of each robot on everything, and that who is silent is not there."""
    record = look.record
    if record.anew and look.moment.heard:
        return _unlike(look, {report.robot for report in record.anew})
    return _unlike(look, set(record.robots)) if record.due_for("beliefs", EVERY_S) else NOTHING


def _unlike(look: Look, robots: set[str]) -> Iterator[str]:
    for name in robots & look.record.robots.keys():
        known, belief = look.record.robots[name], look.world.plant.dispatcher.beliefs[name]
        if known.robot.link in UNSENT:
            continue
        for field in FIELDS:
            said = getattr(known, "boot" if field == "boot_id" else field)
            if getattr(belief, field) != said:
                yield f"{name}: its {field} is taken for {getattr(belief, field)}, its word was {said}"
        if belief.facts != known.facts:
            yield f"{name}: its facts are taken for {belief.facts}, its word was {known.facts}"
        offline = known.offline(look.world.plant.now)
        if belief.online is offline:
            yield f"{name} is {'' if belief.online else 'not '}online by what the plant believes"
        if known.robot.evidence is Evidence.IDS and belief.unhomed is not known.unhomed:
            yield f"{name} is {'not ' if belief.unhomed else ''}homed by what the plant believes"


BELIEFS = (believed_as_said,)
