"""Pose on the floor."""

from __future__ import annotations

import math
from dataclasses import dataclass

FAR = 1e6  # m; no robot measures more, and larger numbers could overflow


@dataclass(frozen=True)
class Pose:
    """Pose in some frame: m, m and rad."""

    x: float
    y: float
    yaw: float = 0.0

    def __matmul__(self, other: Pose) -> Pose:
        """The pose `other`, given in the frame of this pose, in the frame that this pose is given in."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose(
            self.x + cos * other.x - sin * other.y,
            self.y + sin * other.x + cos * other.y,
            wrapped(self.yaw + other.yaw),
        )

    @property
    def inverse(self) -> Pose:
        """The origin of the frame, as seen from this pose."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose(-cos * self.x - sin * self.y, sin * self.x - cos * self.y, -self.yaw)

    @property
    def is_finite(self) -> bool:
        """True if the pose is finite and not absurdly far away."""
        return all(abs(each) < FAR for each in (self.x, self.y, self.yaw))

    def distance(self, other: Pose) -> float:
        return math.hypot(self.x - other.x, self.y - other.y)


def wrapped(angle: float) -> float:
    """The same angle from -pi to pi."""
    return math.remainder(angle, math.tau)
