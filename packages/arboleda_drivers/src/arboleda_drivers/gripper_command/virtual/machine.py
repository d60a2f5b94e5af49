"""Gripper that closes until another goal or a part stops it."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

from arboleda_drivers.ros_action.events import GoalResult, Measurement, Status
from arboleda_drivers.ros_action.joints import JointStateEvent
from arboleda_drivers.ros_action.virtual.faults import FAULTS as OF_ALL
from arboleda_drivers.ros_action.virtual.machine import BadGoal
from arboleda_drivers.ros_action.virtual.ride import Position, Ride

STALL_S = 0.3  # a gripper that has not moved for so long is stalled
PEAK = 15 / 8  # of a ride's speed, by its average
FAULTS = {
    **OF_ALL,
    "empty": "there is no part between the fingers",
    "slip": "a part that is held slips out, and the fingers go on closing",
    "allow_stalling": "a goal that ends at a part is a success, as controllers can be set to have it",
    "jam": "fingers stop half way, as at a part",
    "no_joint": "the joint states lack the finger",
}


@dataclass(frozen=True, kw_only=True)
class Grip:
    """Goal: position of the finger joint, m or rad, and the greatest effort."""

    position: float
    effort: float = 0.0


class GripperBody:
    """Body of a gripper; `opened` is its widest joint position, 0 the closed one, `part` where a part stops
    it."""

    preempted = Status.CANCELED

    def __init__(
        self,
        joint: str,
        faults: Collection[str] = (),
        *,
        opened: float = 0.085,
        part: float = 0.04,
        speed: float = 0.1,
    ) -> None:
        self.joint = joint
        self.position: Position = (opened,)
        self.stalled = False
        self._faults, self._opened, self._part, self._speed = faults, opened, part, speed
        self._goal = opened
        self._stuck_since: float | None = None

    def ride(self, now: float, goal: Grip, slower: float) -> Ride:
        if not math.isfinite(goal.position) or not math.isfinite(goal.effort):
            raise BadGoal("it is no number")
        self._goal = min(max(goal.position, min(0.0, self._opened)), max(0.0, self._opened))
        self._stuck_since = None
        way = abs(self._goal - self.position[0])
        takes_s = max(0.05, PEAK * way / self._speed * slower)
        points = ((now, self.position), (now + takes_s, (self._goal,)))
        return Ride(points=points)

    def moved(self, now: float, position: Position) -> bool:
        """Move towards the goal; a part stops closing fingers, and a stop of STALL_S ends the goal."""
        reached = self._reach(position[0])
        self.position = (reached,)
        if reached == position[0]:
            self._stuck_since = None
            return True
        self._stuck_since = self._stuck_since if self._stuck_since is not None else now
        return now < self._stuck_since + STALL_S

    def rests(self, now: float) -> None:
        """Without a goal it goes on pressing, and closes if the part is gone."""
        if "slip" in self._faults and self.position == (self._part,):
            self.position = (self._goal,)

    def end(self, id: str, ride: Ride, *, arrived: bool) -> GoalResult:
        if arrived and self.position == ride.goal:
            return GoalResult(id=id, status=Status.SUCCEEDED)
        stalled = Status.SUCCEEDED if "allow_stalling" in self._faults else Status.ABORTED
        return GoalResult(id=id, status=stalled, stalled=True)

    def aborted(self, id: str) -> GoalResult:
        return GoalResult(id=id, status=Status.ABORTED)

    def measured(self, stamp: tuple[int, int], position: Position) -> list[Measurement]:
        if "no_joint" in self._faults:
            return [JointStateEvent(names=(), positions=(), stamp=stamp)]
        return [JointStateEvent(names=(self.joint,), positions=position, stamp=stamp)]

    def _reach(self, position: float) -> float:
        """The position that the finger reaches on its way to `position`; a part in between stops it."""
        here, closes = self.position[0], abs(position) <= abs(self.position[0])
        if "jam" in self._faults and abs(position) < abs(self._opened) / 2 <= abs(here):
            return self._opened / 2
        if "empty" in self._faults or not closes or abs(here) < abs(self._part):
            return position
        return position if abs(position) > abs(self._part) else self._part
