"""A pose on the floor."""

from __future__ import annotations

import math
from dataclasses import dataclass

FAR = 1e6  # m; numbers beyond are none that a robot measures, and do not bear to be reckoned with


@dataclass(frozen=True)
class Pose:
    """m, m and rad, in some frame."""

    x: float
    y: float
    yaw: float = 0.0

    def __matmul__(self, other: Pose) -> Pose:
        """What `other`, which is seen from this one, is in the frame of this one."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose(
            self.x + cos * other.x - sin * other.y,
            self.y + sin * other.x + cos * other.y,
            wrapped(self.yaw + other.yaw),
        )

    @property
    def inverse(self) -> Pose:
        """Its frame's origin, as seen from it."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose(-cos * self.x - sin * self.y, sin * self.x - cos * self.y, -self.yaw)

    @property
    def is_finite(self) -> bool:
        """Whether it is on any floor."""
        return all(abs(each) < FAR for each in (self.x, self.y, self.yaw))

    def distance(self, other: Pose) -> float:
        return math.hypot(self.x - other.x, self.y - other.y)


def wrapped(angle: float) -> float:
    """The same angle from -pi to pi."""
    return math.remainder(angle, math.tau)
