"""Shared zones, by where robots and devices truly are."""

from __future__ import annotations

from collections.abc import Iterator

from .invariant import Look, Trigger, invariant


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


ZONES = (one_robot_per_zone, zone_released_only_outside, zone_entered_only_when_held)
