"""Invariants of what a plant keeps for its next start: it is true, and kept before its effects leave."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.drivers import Stop, StopMode, Switch
from arboleda.engine.inspection import parts_of
from arboleda.model.messages import Fact, Remember

from ..recorded.robots import StopProgress
from ..recorded.scopes import UNSENT
from .invariant import Look, Trigger, invariant

KEPT = {StopProgress.LATCHED: "on", StopProgress.CLEARED: "cleared", None: None}


@invariant(Trigger.COMMANDED)
def kept_before_it_leaves(look: Look) -> Iterator[str]:
    """A stop is kept before it leaves, so is its clear, and that an effector is being switched."""
    kept = {
        (fact, name): value for fact, rows in look.record.facts.before.items() for name, value in rows.items()
    }
    for message in look.moment.sent:
        if isinstance(message, Remember):
            kept[message.fact, message.name] = message.value or ""
        elif isinstance(message, Stop) and message.mode is not StopMode.HALT:
            latched = kept.get((Fact.LATCH, message.robot)) == "on"
            if latched is not (message.mode is StopMode.LATCH):
                yield f"{message} leaves, and a latch is {'' if latched else 'not '}kept"
        elif (
            isinstance(message, Switch)
            and message.grips is not None
            and kept.get((Fact.EFFECTOR, message.robot)) != "switching"
        ):
            yield f"{message} leaves, and nobody would know after a restart"


@invariant(Trigger.NEWS)
def kept_is_what_is(look: Look) -> Iterable[str]:
    """The kept states of stops, effectors and zones are their states."""
    return (*_stops(look), *_effectors(look), *_zones(look))


def _stops(look: Look) -> Iterator[str]:
    """Sentences on stops kept wrongly. A cell's clear counts, until its reset, for unstopped robots, too."""
    kept = look.world.disk.facts.get(Fact.LATCH, {})
    for cell in look.record.cells.values():
        for robot in [each for each in cell.cell.robots if each.link not in UNSENT]:
            stop, word = look.record.robots[robot.name].stop, kept.get(robot.name)
            if word != KEPT[stop] and not (stop is None and cell.stopped and word == "cleared"):
                yield f"{robot.name} is {stop.value if stop else 'not stopped'}, and {word} is kept"


def _effectors(look: Look) -> Iterator[str]:
    kept = look.world.disk.facts.get(Fact.EFFECTOR, {})
    for cell in look.record.cells.values():
        for name in cell.cell.holders:
            grip = parts_of(cell.run).grip(name)
            if kept.get(name, "off") != grip:
                yield f"the effector of {name} is {grip.value}, kept is {kept.get(name)}"


def _zones(look: Look) -> Iterator[str]:
    zones = look.world.plant.zones
    for zone, robot in look.world.disk.facts.get(Fact.QUARANTINE, {}).items():
        if zones.holder(zone) != robot:
            yield f"zone {zone} belongs to {zones.holder(zone) or 'nobody'}, and is kept for {robot}"


MEMORY = (kept_before_it_leaves, kept_is_what_is)
