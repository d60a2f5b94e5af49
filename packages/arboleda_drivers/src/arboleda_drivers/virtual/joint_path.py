"""Motion of virtual arms: all joints begin and end together, with the ramps of one of them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

Joints = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Path:
    """Path of an arm, by the `length` of its leading joint; a stop at `braked_s` brakes it on the way."""

    start: Joints
    goal: Joints
    began_at: float
    length: float
    speed: float
    acceleration: float
    braked_s: float = math.inf

    @property
    def ends_at(self) -> float:
        if self.braked_s < math.inf:
            return self.began_at + self.braked_s + self._speed(self.braked_s) / self.acceleration
        return self.began_at + self._total_s

    def at(self, now: float) -> Joints:
        """The joints at a time."""
        if self.length == 0:
            return self.goal
        part = self._travelled(max(0.0, min(now, self.ends_at) - self.began_at)) / self.length
        return tuple(a + (b - a) * part for a, b in zip(self.start, self.goal, strict=True))

    def braked(self, now: float) -> Path:
        """The path after a stop that is given now."""
        return replace(self, braked_s=min(self.braked_s, now - self.began_at))

    @property
    def _ramp_s(self) -> float:
        return self.speed / self.acceleration

    @property
    def _total_s(self) -> float:
        return self.length / self.speed + self._ramp_s

    def _speed(self, s: float) -> float:
        ramps = min(s, self._total_s - s) * self.acceleration
        return max(0.0, min(ramps, self.speed))

    def _travelled(self, s: float) -> float:
        if s > self.braked_s:
            more = s - self.braked_s
            braking = self._speed(self.braked_s) * more - self.acceleration * more**2 / 2
            return self._travelled(self.braked_s) + braking
        if s <= self._ramp_s:
            return self.acceleration * s**2 / 2
        if s <= self._total_s - self._ramp_s:
            return self.speed * (s - self._ramp_s / 2)
        return self.length - self.acceleration * max(0.0, self._total_s - s) ** 2 / 2


def between(
    start: Joints, goal: Joints, now: float, *, speed: float, acceleration: float, leading: int
) -> Path:
    """The path of a joint move that begins now; speed and acceleration are of its leading joint."""
    length = abs(goal[leading] - start[leading])
    fastest = math.sqrt(length * acceleration) or 1.0  # the speed at which the ramps meet
    return Path(
        start=start,
        goal=goal,
        began_at=now,
        length=length,
        speed=min(speed, fastest),
        acceleration=acceleration,
    )
