"""Layout of a drawn cell of devices: who is in it, where robots go, and what needs what."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .kinds import Kind, Verb
from .steps import Param, Value

Section = dict[str, Any]
Need = tuple[str, str, Value]  # role, fact, value


@dataclass(frozen=True, kw_only=True)
class Device:
    """A device in a role, other than a robot or a person."""

    role: str
    kind: Kind
    evidence: str = "ids"
    tool_of: str = ""
    is_shared: bool = False
    section: Section = field(default_factory=dict)

    @property
    def tells_facts(self) -> bool:
        return self.evidence != "state"


@dataclass(frozen=True, kw_only=True)
class Robot:
    """A robot with its targets by name; `doors` are facts that have to be so before it goes to one.

    `tool` is the role of what it carries; empty: its own effector; None: it has none.
    """

    role: str
    targets: tuple[str, ...]
    doors: Mapping[str, Need | None]  # of targets in zones
    tool: str | None
    is_shared: bool = False
    paths: tuple[str, ...] = ()  # the codes of those over which it drives
    section: Section = field(default_factory=dict)

    def door(self, target: str | Param) -> Need | None:
        """The condition for going there, whatever a parameter is; a mobile robot may come by each
        node on its way.
        """
        if isinstance(target, Param) or self.section.get("kind") == "mobile":
            return next(iter(self.doors.values()), None)
        return self.doors.get(target)


@dataclass(frozen=True, kw_only=True)
class Parts:
    """Places of parts: `source` is the group that people keep filled, `nest` may be in a machine."""

    robot: str
    source: str
    sources: tuple[str, ...]
    goal: str
    nest: str = ""
    machine: str = ""


@dataclass(frozen=True, kw_only=True)
class Layout:
    """One cell; `needs` are those of verbs on other devices, by role and verb."""

    devices: tuple[Device, ...]
    robots: tuple[Robot, ...]
    people: tuple[str, ...]
    needs: Mapping[tuple[str, str], tuple[Need, ...]]
    apart: tuple[frozenset[str], ...]  # roles that nothing joins, so they can work at the same time
    parts: Parts | None = None
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    shared_people: tuple[str, ...] = ()
    waits: frozenset[tuple[str, str]] = frozenset()  # verbs that wait for a zone, by role and name

    @property
    def lock_roles(self) -> set[str]:
        """The machines whose facts free a zone."""
        doors = {door[0] for robot in self.robots for door in robot.doors.values() if door is not None}
        return doors | {need[0] for key in self.waits for need in self.needs[key]}

    def device(self, role: str) -> Device:
        return next(each for each in self.devices if each.role == role)

    def robot(self, role: str) -> Robot:
        return next(each for each in self.robots if each.role == role)

    def all_needs(self, role: str, verb: Verb) -> list[Need]:
        """The needs of a verb on its own device and on others."""
        return [*((role, fact, value) for fact, value in verb.needs), *self.needs.get((role, verb.name), ())]

    def rank(self, need: Need) -> tuple[int, int]:
        """The place of a fact in the order in which verbs need only facts before those that they set."""
        index = next(n for n, each in enumerate(self.devices) if each.role == need[0])
        return index, [name for name, _ in self.devices[index].kind.facts].index(need[1])

    @property
    def shared_roles(self) -> tuple[str, ...]:
        return (*(each.role for each in self.members if each.is_shared), *self.shared_people)

    @property
    def shared_hand(self) -> frozenset[str]:
        """The arm that cells share, and its tool, where it moves their parts."""
        robot = self.robot(self.parts.robot) if self.parts is not None else None
        return frozenset(
            {robot.role, robot.tool or robot.role} if robot is not None and robot.is_shared else ()
        )

    @property
    def members(self) -> tuple[Device | Robot, ...]:
        """All that is in the cell but people."""
        return (*self.devices, *self.robots)
