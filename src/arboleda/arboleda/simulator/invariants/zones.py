"""Shared zones, by where robots and devices truly are."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.common import Status

from arboleda.core.cell import CellRun
from arboleda.core.cell_states import CellState
from arboleda.model.sentence import Sentence
from arboleda.trees.leaves import TakeDevices, TakeZones

from .invariant import Look, Trigger, invariant

EVERY_S = 1.0


@invariant(Trigger.MET)
def one_robot_per_zone(look: Look) -> Iterator[str]:
    """At most one robot or device is in a shared zone, or may have swept it, unless an operator said else."""
    for meeting in look.truth.zones.meetings:
        theirs = [name for name in meeting.arms if name not in meeting.excused]
        theirs = [name for name in theirs if not look.truth.mistaken(look.truth.robots[name])]
        if len(theirs) > 1:
            yield f"{' and '.join(theirs)} are in zone {meeting.zone}"


@invariant(Trigger.FREED)
def zone_released_only_outside(look: Look) -> Iterator[str]:
    """The plant frees a zone only if who had it is truly outside, or on an operator's override."""
    for freed in look.truth.zones.freed:
        who = look.truth.robots.get(freed.arm)
        if who is not None and freed.zone in who.zones and not freed.by_hand and not look.truth.mistaken(who):
            yield f"zone {freed.zone} is taken from {freed.arm}, which is still in it"


@invariant(Trigger.ENTERED)
def zone_entered_only_when_held(look: Look) -> Iterator[str]:
    """A robot that gets into a shared zone does so only while the plant keeps that zone for it."""
    for entry in look.truth.zones.entries:
        kept_for = entry.holder or "nobody"
        if kept_for != entry.arm and not look.truth.mistaken(look.truth.robots[entry.arm]):
            yield f"{entry.arm} enters zone {entry.zone}, which the plant keeps for {kept_for}"


@invariant(Trigger.FREED, every_s=EVERY_S)
def a_wait_names_its_cause(look: Look) -> Iterator[str]:
    """A step that waits for zones or for shared devices says why, and names who has one of them now."""
    for run in look.world.plant.cells.values():
        if run.tree is not None and run.state is CellState.EXECUTE:
            yield from _silent_waits(look, run)


def _silent_waits(look: Look, run: CellRun) -> Iterator[str]:
    name = run.cell.name
    for node in run.run.nodes:
        if node.status is not Status.RUNNING or not isinstance(node, TakeZones | TakeDevices):
            continue
        asks = (node.robot, node.zones) if isinstance(node, TakeZones) else (name, node.devices)
        holders = {look.world.plant.zones.holder(each) for each in asks[1]} - {None, asks[0]}
        if not node.feedback:
            yield f"{name} waits in {node.name} and does not say for what"
        elif holders and holders.isdisjoint(_named(node.feedback)):
            yield f"{name} {node.feedback}, and {', '.join(sorted(map(str, holders)))} has it"


def _named(sentence: Sentence) -> set[object]:
    return {each for each in sentence.values.values() if isinstance(each, str)}


ZONES = (
    one_robot_per_zone,
    zone_released_only_outside,
    zone_entered_only_when_held,
    a_wait_names_its_cause,
)
