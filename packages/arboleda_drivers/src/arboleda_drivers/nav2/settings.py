"""The keys of the drivers in a plant file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from arboleda.drivers import Evidence, Mobile, Robot

from .pose import Pose


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the drivers of Nav2: the base's action, its localisation, and the plant's floor on its map.

    Without `localisation`, odometry has to be in the frame of the map. `tolerance_m` is how far from a node
    the base still stands on it. `lan` lets the driver reach other machines.
    """

    action: str
    odometry: str = "odom"
    localisation: str = "amcl_pose"
    frame: str = "map"
    floor_m: tuple[float, float] = (0.0, 0.0)
    floor_yaw_deg: float = 0.0
    tolerance_m: float = 0.1
    unlocalised_m: float = 2.0
    lan: bool = False

    def __post_init__(self) -> None:
        for name in ("action", "odometry", "frame"):
            if not getattr(self, name):
                raise ValueError(f"{name} is empty; it is a name of ROS 2")
        for name, most in (("tolerance_m", 5.0), ("unlocalised_m", 100.0)):
            if not 0 < getattr(self, name) <= most:
                raise ValueError(f"{name} is {getattr(self, name):g}; allowed: more than 0, to {most:g}")

    @property
    def floor(self) -> Pose:
        """The pose of the origin of the plant's floor on the map."""
        return Pose(*self.floor_m, math.radians(self.floor_yaw_deg))

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if device.evidence is not Evidence.IDS:
            yield (), f"{device.name} has evidence: {device.evidence.value}; an action proves ids"
        if not isinstance(device, Mobile):
            yield (), f"{device.name} is no mobile robot; Nav2 drives those"
        elif self.tolerance_m >= device.grid.pitch / 2:
            half = device.grid.pitch / 2
            yield (
                ("tolerance_m",),
                f"{self.tolerance_m:g} m is not less than half of the way to the next node, {half:g} m",
            )


@dataclass(frozen=True, kw_only=True)
class ToPose(Settings):
    """Settings of `navigate_to_pose`: each node of a way is a goal of its own."""

    action: str = "navigate_to_pose"


@dataclass(frozen=True, kw_only=True)
class Waypoints(Settings):
    """Settings of `follow_waypoints`: all nodes of a way are one goal."""

    action: str = "follow_waypoints"
