"""Truth about shared zones: the robots and devices in each, and the zones just freed by the plant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from arboleda.rig.world import World

from .robot import RobotTruth


@dataclass(frozen=True, kw_only=True)
class FreedZone:
    """A zone that the plant took from the arm that held it; `by_hand`: on an operator's word."""

    zone: str
    arm: str
    by_hand: bool


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """A zone with more than one arm in it; for those in `excused` only an operator, or a lie, is to blame.

    An arm is excused from an override, or from the release of its zone on false evidence, until it has left.
    """

    zone: str
    arms: tuple[str, ...]
    excused: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Entry:
    """An arm that set out into a zone, and the arm that held the zone then by the plant's books."""

    zone: str
    arm: str
    holder: str | None


class ZonesTruth:
    """Zones in this step: `freed`, `meetings`, `entries`."""

    def __init__(
        self, world: World, robots: Mapping[str, RobotTruth], mistaken: Callable[[RobotTruth], bool]
    ) -> None:
        self.meetings: list[Meeting] = []
        self.freed: list[FreedZone] = []
        self.entries: list[Entry] = []
        self._world = world
        self._robots = robots
        self._mistaken = mistaken
        self._names = world.model.zones
        self._holders = {zone: world.plant.zones.holder(zone) for zone in self._names}
        self._inside = {zone: self._who_is_in(zone) for zone in self._names}
        self._overridden: set[str] = set()  # zones, in this step
        self._answered_for: set[tuple[str, str]] = set()  # (zone, arm) until the arm is truly outside

    def overridden(self, zone: str) -> None:
        """Take in that an operator has vouched for a zone being empty."""
        self._overridden.add(zone)
        self._answered_for.update((zone, name) for name in self._who_is_in(zone))

    def look(self, moved: bool) -> None:
        """Take in where the arms are, if they `moved`, and the holders of zones by the plant's books."""
        if self.meetings or self.freed or self.entries:
            self.meetings, self.freed, self.entries = [], [], []
        if moved:
            self._look_inside()
        holders = self._world.plant.zones.holders
        for zone, before in self._holders.items():
            if (now := holders.get(zone)) != before:
                self._holders[zone] = now
                if before is not None:
                    self._freed(zone, before)
        if self._overridden:
            self._overridden = set()

    def _freed(self, zone: str, name: str) -> None:
        self.freed.append(FreedZone(zone=zone, arm=name, by_hand=zone in self._overridden))
        arm = self._robots.get(name)
        if arm is not None and zone in arm.zones and self._mistaken(arm):
            self._answered_for.add((zone, name))

    def _who_is_in(self, zone: str) -> list[str]:
        return [name for name, arm in self._robots.items() if zone in arm.zones]

    def _look_inside(self) -> None:
        for zone, before in self._inside.items():
            inside = self._who_is_in(zone)
            if inside == before:
                continue
            self._inside[zone] = inside
            holder = self._holders[zone]  # before this step: the boards step before the plant
            new = [name for name in inside if name not in before]
            put_there = [name for name in new if self._robots[name].unbidden]
            self._answered_for.update((zone, name) for name in put_there)
            self.entries += [
                Entry(zone=zone, arm=name, holder=holder) for name in new if name not in put_there
            ]
            self._answered_for = {
                (where, name) for where, name in self._answered_for if where != zone or name in inside
            }
            if len(inside) > 1:
                excused = tuple(name for name in inside if (zone, name) in self._answered_for)
                self.meetings.append(Meeting(zone=zone, arms=tuple(inside), excused=excused))
