"""Base that drives straight from pose to pose, with odometry, and a localisation that speaks on its way."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

from arboleda_drivers.nav2.localisation import MapPose, OdometryPose
from arboleda_drivers.nav2.pose import Pose, wrapped
from arboleda_drivers.ros_action.events import GoalResult, Measurement, Status
from arboleda_drivers.ros_action.virtual.faults import FAULTS as OF_ALL
from arboleda_drivers.ros_action.virtual.machine import BadGoal
from arboleda_drivers.ros_action.virtual.ride import Position, Ride

TURN_RAD_S = 1.5
PEAK = 15 / 8  # of a ride's speed, by its average
LOCALISED_M = 0.2  # as amcl, it says where the base is whenever that has gone so far
SILENCE_S = 0.5  # after so long without an estimate it publishes one at once
JUMP_M = 0.5
FAULTS = {
    **OF_ALL,
    "abort": "a goal is aborted half way, as where every recovery has failed",
    "unlocalised": "localisation says nothing more",
    "jump": "localisation says a place that is half a meter beside",
    "no_odometry": "odometry says nothing",
    "missed": "the first of several waypoints is left out, and the goal succeeds",
    "wrong_frame": "goals are refused, as in a frame that nobody knows",
}


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Goal: poses in the frame of the map."""

    frame: str
    poses: tuple[Pose, ...]


class BaseBody:
    """Body of a base; odometry starts at its first pose, localisation knows the map."""

    preempted = Status.ABORTED

    def __init__(
        self, faults: Collection[str] = (), *, start: Pose, speed: float = 0.5, frame: str = "map"
    ) -> None:
        self.position: Position = (start.x, start.y, start.yaw)
        self._start, self._speed, self._frame, self._faults = start, speed, frame, faults
        self._estimate: Pose | None = None  # by localisation
        self._estimated_at = -math.inf
        self._missed = False

    def ride(self, now: float, goal: Drive, slower: float) -> Ride:
        poses = goal.poses
        known = goal.frame in ("", self._frame) and "wrong_frame" not in self._faults
        if not known or not poses or not all(each.is_finite for each in poses):
            raise BadGoal("its frame or its poses are none")
        self._missed = "missed" in self._faults and len(poses) > 1
        points, at = [(now, self.position)], now
        for pose in poses[1:] if self._missed else poses:
            x, y, yaw = points[-1][1]
            turn = wrapped(pose.yaw - yaw)
            takes_s = max(math.hypot(pose.x - x, pose.y - y) / self._speed, abs(turn) / TURN_RAD_S, 0.05)
            at += PEAK * takes_s * slower
            points.append((at, (pose.x, pose.y, yaw + turn)))
        return Ride(points=tuple(points))

    def moved(self, now: float, position: Position) -> bool:
        self.position = position
        return True

    def rests(self, now: float) -> None:
        """Without a goal it stands."""

    def end(self, id: str, ride: Ride, *, arrived: bool) -> GoalResult:
        return GoalResult(id=id, status=Status.SUCCEEDED, missed=(0,) if self._missed else ())

    def aborted(self, id: str) -> GoalResult:
        return GoalResult(id=id, status=Status.ABORTED)

    def measured(self, stamp: tuple[int, int], position: Position) -> list[Measurement]:
        pose = Pose(*position)
        measurements: list[Measurement] = []
        if "no_odometry" not in self._faults:
            measurements.append(OdometryPose(stamp=stamp, pose=self._start.inverse @ pose))
        at = stamp[0] + stamp[1] / 1e9
        quiet = at > self._estimated_at + SILENCE_S
        self._estimated_at = at
        if "unlocalised" in self._faults:
            return measurements
        found = replace(pose, y=pose.y + JUMP_M) if "jump" in self._faults else pose
        if self._estimate is None or quiet or not self._estimate.distance(found) < LOCALISED_M:
            self._estimate = found
            measurements.append(MapPose(stamp=stamp, pose=found))
        return measurements
