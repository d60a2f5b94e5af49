"""Arm behind a joint trajectory controller; it takes any number of points with their times."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise

from arboleda_drivers.ros_action.events import GoalResult, Measurement, Status
from arboleda_drivers.ros_action.joints import JointStateEvent
from arboleda_drivers.ros_action.virtual.faults import FAULTS as OF_ALL
from arboleda_drivers.ros_action.virtual.machine import BadGoal
from arboleda_drivers.ros_action.virtual.ride import Position, Ride

PATH_TOLERANCE = -4
FAULTS = {
    **OF_ALL,
    "abort": "a goal is aborted half way: PATH_TOLERANCE_VIOLATED",
    "no_joint": "the joint states lack the last joint",
}


@dataclass(frozen=True, kw_only=True)
class Points:
    """Trajectory: positions of joints, each with its time from the start, s."""

    joints: tuple[str, ...]
    points: tuple[tuple[float, Position], ...]


class ArmBody:
    """Body of an arm that follows its points, each from rest to rest."""

    preempted = Status.CANCELED

    def __init__(self, joints: Sequence[str], faults: Collection[str] = ()) -> None:
        self.joints = tuple(joints)
        self.position: Position = (0.0,) * len(self.joints)
        self._faults = faults

    def ride(self, now: float, goal: Points, slower: float) -> Ride:
        if sorted(goal.joints) != sorted(self.joints) or not goal.points:
            raise BadGoal("its joints are others")
        times = [0.0, *(at for at, _ in goal.points)]
        numbers = [*times, *(value for _, q in goal.points for value in q)]
        short = any(len(q) != len(goal.joints) for _, q in goal.points)
        if short or not all(map(math.isfinite, numbers)) or any(b <= a for a, b in pairwise(times)):
            raise BadGoal("its points are none")
        order = [goal.joints.index(name) for name in self.joints]
        points = ((now + at * slower, tuple(q[index] for index in order)) for at, q in goal.points)
        return Ride(points=((now, self.position), *points))

    def moved(self, now: float, position: Position) -> bool:
        self.position = position
        return True

    def rests(self, now: float) -> None:
        """Without a goal it holds its position."""

    def end(self, id: str, ride: Ride, *, arrived: bool) -> GoalResult:
        return GoalResult(id=id, status=Status.SUCCEEDED)

    def aborted(self, id: str) -> GoalResult:
        return GoalResult(id=id, status=Status.ABORTED, error=PATH_TOLERANCE, text="a joint left its path")

    def measured(self, stamp: tuple[int, int], position: Position) -> list[Measurement]:
        names = self.joints
        if "no_joint" in self._faults:
            names, position = names[:-1], position[:-1]
        return [JointStateEvent(names=names, positions=position, stamp=stamp)]
