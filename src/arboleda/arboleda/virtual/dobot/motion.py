"""Motion of the virtual arm: all joints begin and end together, with the ramps of the slowest of them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

SPEED_DEG_S = (150.0, 150.0, 180.0, 223.0, 223.0, 223.0)  # of a CR10A, as its maker publishes them
ACCELERATION_DEG_S2 = 180.0
Joints = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Path:
    """Path of an arm, by the `length_deg` of its slowest joint; a stop at `braked_s` brakes it on the way."""

    start: Joints
    goal: Joints
    began_at: float
    length_deg: float
    speed_deg_s: float
    acceleration_deg_s2: float
    braked_s: float = math.inf

    @property
    def ends_at(self) -> float:
        if self.braked_s < math.inf:
            return self.began_at + self.braked_s + self._speed(self.braked_s) / self.acceleration_deg_s2
        return self.began_at + self._total_s

    def at(self, now: float) -> Joints:
        """The joints at a time, deg."""
        if self.length_deg == 0:
            return self.goal
        part = self._travelled(max(0.0, min(now, self.ends_at) - self.began_at)) / self.length_deg
        return tuple(a + (b - a) * part for a, b in zip(self.start, self.goal, strict=True))

    def braked(self, now: float) -> Path:
        """The path after a stop that is given now."""
        return replace(self, braked_s=min(self.braked_s, now - self.began_at))

    @property
    def _ramp_s(self) -> float:
        return self.speed_deg_s / self.acceleration_deg_s2

    @property
    def _total_s(self) -> float:
        return self.length_deg / self.speed_deg_s + self._ramp_s

    def _speed(self, s: float) -> float:
        ramps = min(s, self._total_s - s) * self.acceleration_deg_s2
        return max(0.0, min(ramps, self.speed_deg_s))

    def _travelled(self, s: float) -> float:
        if s > self.braked_s:
            more = s - self.braked_s
            braking = self._speed(self.braked_s) * more - self.acceleration_deg_s2 * more**2 / 2
            return self._travelled(self.braked_s) + braking
        if s <= self._ramp_s:
            return self.acceleration_deg_s2 * s**2 / 2
        if s <= self._total_s - self._ramp_s:
            return self.speed_deg_s * (s - self._ramp_s / 2)
        return self.length_deg - self.acceleration_deg_s2 * max(0.0, self._total_s - s) ** 2 / 2


def path(start: Joints, goal: Joints, now: float, speed_percent: float, acceleration_percent: float) -> Path:
    """The path of a joint move that begins now."""
    distances = [abs(b - a) for a, b in zip(start, goal, strict=True)]
    times = [distance / speed for distance, speed in zip(distances, SPEED_DEG_S, strict=True)]
    slowest = times.index(max(times))
    acceleration = ACCELERATION_DEG_S2 * acceleration_percent / 100
    length = distances[slowest]
    fastest = math.sqrt(length * acceleration) or 1.0  # the speed at which the ramps meet
    return Path(
        start=start,
        goal=goal,
        began_at=now,
        length_deg=length,
        speed_deg_s=min(SPEED_DEG_S[slowest] * speed_percent / 100, fastest),
        acceleration_deg_s2=acceleration,
    )
