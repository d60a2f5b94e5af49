"""Robots of joints: their position, their motions, and the proof of these."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

from arboleda.model.commands import Motion, Position
from arboleda.model.counting import counted
from arboleda.model.messages import Report
from arboleda.model.movement import Movement
from arboleda.model.plant_model import Robot

ROUNDING = 1e-9  # rad or m, far below a motor step


@dataclass(frozen=True, kw_only=True)
class MoveJoints(Motion):
    """Drive a robot to the joint positions `q`, one for each joint: rad, or m for a prismatic joint."""

    q: tuple[float, ...]

    @property
    def way(self) -> tuple[Position, ...]:
        return (self.q,)


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Axis: position in rad (revolute) or m (prismatic); `step` is one motor step in that unit."""

    name: str
    lower: float
    upper: float
    speed: float
    acceleration: float
    step: float
    pinion_radius_m: float | None = None  # None: revolute; else the rack pinion of a prismatic axis
    up: int = -1  # the lifting direction of a prismatic axis: -1 smaller values, 1 greater ones, 0 none

    @property
    def unit(self) -> str:
        return "rad" if self.pinion_radius_m is None else "m"

    def steps(self, value: float) -> int:
        """The whole motor step nearest to `value`, halves away from zero."""
        return math.floor(abs(value) / self.step + 0.5) * (1 if value >= 0 else -1)

    def quantised(self, value: float) -> float:
        """`value` as the motor can hold it."""
        return self.steps(value) * self.step

    def within(self, value: float) -> float:
        """`value`, or the limit that it is beyond, as the motor step nearest to a limit may be."""
        return min(max(value, self.lower), self.upper)

    def at_rate(self, rate: float) -> Joint:
        return replace(self, speed=self.speed * rate, acceleration=self.acceleration * rate**2)

    def higher(self, value: float, *others: float) -> float:
        """The highest of these values if the joint lifts, else `value`."""
        if self.pinion_radius_m is None or self.up == 0:
            return value
        return min(value, *others) if self.up < 0 else max(value, *others)

    def travel_s(self, distance: float) -> float:
        """Time of a rest-to-rest move over `distance` with constant acceleration."""
        distance = abs(distance)
        ramp = self.speed**2 / self.acceleration
        if distance < ramp:
            return 2 * math.sqrt(distance / self.acceleration)
        return distance / self.speed + self.speed / self.acceleration


@dataclass(frozen=True, kw_only=True)
class Description:
    """Model given by the plant: its URDF without a prefix, and the assumptions made on it."""

    urdf: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Jointed(Robot):
    """Robot whose position is a number for each of its joints.

    `tolerance` per joint overrides the default of half a motor step + 1e-5. `model` is that of its drawing,
    empty where it has none.
    """

    kind_name: str = "axes"
    joints: tuple[Joint, ...] = ()
    model: str = ""
    description: Description | None = None  # None: the model comes with arboleda_description
    tolerance: tuple[float, ...] | None = None
    position_key: ClassVar[str | None] = "q"
    unsaid: ClassVar[tuple[str, ...]] = ("node", "effector", "piece")  # what no report of it has

    @property
    def joint_names(self) -> tuple[str, ...]:
        return tuple(f"{self.twin_name}_{joint.name}" for joint in self.joints)

    def measured(self, report: Report) -> tuple[float, ...] | None:
        return report.q

    @property
    def units(self) -> list[str]:
        return [joint.unit for joint in self.joints]

    def objection(self, report: Report) -> str | None:
        for key in self.unsaid:
            if getattr(report, key) is not None:
                return f"{key} was said; {self.name} is a robot of joints and has none"
        if report.q is not None and len(report.q) != len(self.joints):
            has = f"{self.name} has {counted(len(self.joints), 'joint')}"
            return f"q has {counted(len(report.q), 'value')}; {has}"
        return None

    @cached_property
    def motion(self) -> JointMotion:
        return JointMotion(self)

    def go(self, *, id: str, way: Sequence[Position]) -> MoveJoints:
        goal = way[-1]
        assert isinstance(goal, tuple)
        return MoveJoints(id=id, robot=self.name, q=goal)

    @cached_property
    def reference(self) -> tuple[float, ...]:
        """The joints at the end of the homing routine, from which the counters begin."""
        return (0.0,) * len(self.joints)

    @cached_property
    def tolerances(self) -> tuple[float, ...]:
        return self.tolerance or tuple(joint.step / 2 + 1e-5 for joint in self.joints)

    def quantised(self, q: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(joint.quantised(value) for joint, value in zip(self.joints, q, strict=True))

    def reached(self, q: tuple[float, ...], target: tuple[float, ...]) -> bool:
        """True if reported joints `q` lie within tolerance of a quantised target."""
        rows = zip(q, target, self.tolerances, strict=True)
        return all(abs(value - goal) <= tolerance for value, goal, tolerance in rows)

    def at_rate(self, rate: float) -> Jointed:
        """The same robot at `rate` times its speed, and its square for accelerations: ramps keep their
        shape."""
        return replace(self, joints=tuple(joint.at_rate(rate) for joint in self.joints))


class JointMotion(Movement):
    """Movement of a robot whose joints all start and arrive together."""

    def __init__(self, robot: Jointed) -> None:
        self.robot = robot
        self.joints = robot.joints

    def held_at(self, position: Position) -> Position:
        assert isinstance(position, tuple)
        return self.robot.quantised(position)

    def lifted(self, position: Position, heights: Sequence[Position]) -> Position:
        """The position with its lifting (prismatic) joints at the highest of `heights`, within limits."""
        assert isinstance(position, tuple)
        rows = zip(self.joints, position, *[up for up in heights if isinstance(up, tuple)], strict=True)
        return tuple(joint.higher(joint.within(q), *above) for joint, q, *above in rows)

    def stands_at(self, position: Position, goal: Position) -> bool:
        assert isinstance(position, tuple) and isinstance(goal, tuple)
        return self.robot.reached(position, self.robot.quantised(goal))

    def confuses(self, position: Position, other: Position) -> bool:
        """True if the robot, stopped within tolerance of one position, may count as standing at the other."""
        assert isinstance(position, tuple) and isinstance(other, tuple)
        rows = zip(
            self.robot.quantised(position), self.robot.quantised(other), self.robot.tolerances, strict=True
        )
        return all(abs(a - b) <= 2 * within + ROUNDING for a, b, within in rows)

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """Time of a joint move; from an unknown start, or one that cannot be, the longest possible one."""
        longest_s = max(joint.travel_s(joint.upper - joint.lower) for joint in self.joints)
        if start is None:
            return longest_s
        assert isinstance(start, tuple) and isinstance(way[-1], tuple)
        rows = zip(self.joints, start, way[-1], strict=True)
        return min(longest_s, max(joint.travel_s(there - here) for joint, here, there in rows))

    def can_have_moved(self, before: Position, after: Position, elapsed_s: float) -> bool:
        assert isinstance(before, tuple) and isinstance(after, tuple)
        rows = zip(self.joints, before, after, strict=True)
        return all(abs(now - then) <= joint.speed * elapsed_s + 2 * joint.step for joint, then, now in rows)
