"""Shared zones, by where the arms truly are."""

from __future__ import annotations

from collections.abc import Iterator

from .invariant import Look, When, invariant


@invariant(When.MET)
def one_robot_per_zone(look: Look) -> Iterator[str]:
    """At most one arm is, or may have swept, in a shared zone, unless an operator answered for it."""
    for meeting in look.truth.zones.meetings:
        theirs = [name for name in meeting.arms if name not in meeting.excused]
        theirs = [name for name in theirs if not look.truth.mistaken(look.truth.arms[name])]
        if len(theirs) > 1:
            yield f"{' and '.join(theirs)} are in zone {meeting.zone}"


@invariant(When.FREED)
def zone_released_only_outside(look: Look) -> Iterator[str]:
    """The plant frees a zone only if its arm is truly outside, or on an operator's override."""
    for freed in look.truth.zones.freed:
        arm = look.truth.arms.get(freed.arm)
        if arm is not None and freed.zone in arm.zones and not freed.by_hand and not look.truth.mistaken(arm):
            yield f"zone {freed.zone} is taken from {freed.arm}, which is still in it"


@invariant(When.ENTERED)
def zone_entered_only_when_held(look: Look) -> Iterator[str]:
    """An arm sets out into a shared zone only while the plant keeps that zone for it."""
    for entry in look.truth.zones.entries:
        kept_for = entry.holder or "nobody"
        if kept_for != entry.arm and not look.truth.mistaken(look.truth.arms[entry.arm]):
            yield f"{entry.arm} enters zone {entry.zone}, which the plant keeps for {kept_for}"


ZONES = (one_robot_per_zone, zone_released_only_outside, zone_entered_only_when_held)
