"""Pose of a base on its map: the last one from localisation, plus the odometry counted since.

Localisation such as amcl speaks only while the base drives, and up to a quarter of a meter apart. Odometry
speaks many times a second and drifts. Both together are what the frames `map`, `odom` and `base_link` say
of each other, found without them.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from arboleda_drivers.ros_action.events import Measurement
from arboleda_drivers.ros_action.goal import Rest

from .pose import Pose, wrapped

SILENT_S = 1.0  # odometry comes many times a second
TOGETHER_S = 0.5  # measurements within this time count as of the same moment
KEPT = 200  # poses of odometry, some seconds of it
STILL_M = 0.005  # or rad; less than this is noise


@dataclass(frozen=True, kw_only=True)
class MapPose(Measurement):
    """Event: localisation measured the pose of the base on the map."""

    pose: Pose


@dataclass(frozen=True, kw_only=True)
class OdometryPose(Measurement):
    """Event: odometry measured the way of the base from its starting point."""

    pose: Pose


class Localisation:
    """Estimate of the pose; after `far_m` without a word from localisation the base counts as lost."""

    def __init__(self, *, odometry: str, localisation: str, far_m: float) -> None:
        self.measured_at = -math.inf
        self.rest = Rest(STILL_M)
        self._odometry, self._localisation, self._far_m = odometry, localisation, far_m
        self._counted: deque[OdometryPose] = deque(maxlen=KEPT)
        self._early: MapPose | None = None  # came before any odometry
        self._map: Pose | None = None  # the starting point of odometry, on the map
        self._gone_m = 0.0  # since localisation spoke
        self._turned = 0.0  # without a jump from pi to -pi

    @property
    def pose(self) -> Pose | None:
        """The base's pose on the map; None if it is not known."""
        if self._map is None or not self._counted:
            return None
        return self._map @ self._counted[-1].pose

    def see(self, now: float, measurement: Measurement) -> bool:
        """Take a measurement; True if it is news.

        A pose with a NaN, or with the time of the one before, is ignored.
        """
        if isinstance(measurement, OdometryPose) and measurement.pose.is_finite:
            return self._count(now, measurement)
        if isinstance(measurement, MapPose) and measurement.pose.is_finite:
            self._localise(measurement)
        return False

    def missing(self, now: float) -> str:
        if now >= self.measured_at + SILENT_S:
            return f"{self._odometry} has said nothing new for {SILENT_S:g} s"
        if self._map is None:
            return f"{self._localisation} has not said yet where the base is"
        if self._gone_m > self._far_m:
            return f"{self._localisation} has said nothing new over {self._far_m:g} m of way"
        return ""

    def _count(self, now: float, measurement: OdometryPose) -> bool:
        before = self._counted[-1] if self._counted else None
        if before is not None and before.stamp == measurement.stamp:
            return False
        if before is not None:
            self._gone_m += before.pose.distance(measurement.pose)
            self._turned += wrapped(measurement.pose.yaw - before.pose.yaw)
        self._counted.append(measurement)
        self.measured_at = now
        if not self._localisation:
            self._map, self._gone_m = Pose(0.0, 0.0), 0.0
        elif self._early is not None:
            early, self._early = self._early, None
            self._localise(early)
        self.rest.look(now, (measurement.pose.x, measurement.pose.y, self._turned))
        return self._map is not None

    def _localise(self, measurement: MapPose) -> None:
        """Note where odometry began on the map, by the odometry of the same time."""
        if not self._counted:
            self._early = measurement
            return
        then = min(self._counted, key=lambda each: abs(_seconds(each) - _seconds(measurement)))
        if self._map is not None and abs(_seconds(then) - _seconds(measurement)) > TOGETHER_S:
            return  # odometry was silent then, so the way since is unknown
        self._map, self._gone_m = measurement.pose @ then.pose.inverse, 0.0


def _seconds(measurement: Measurement) -> float:
    return measurement.stamp[0] + measurement.stamp[1] / 1e9
