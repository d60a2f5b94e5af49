"""Motion of virtual arms: all joints begin and end together, with the ramps of one of them."""

from __future__ import annotations

import math
from collections.abc import Collection
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

    def part(self, now: float) -> float:
        """The part of its time that has passed."""
        whole_s = self.ends_at - self.began_at
        return 1.0 if whole_s <= 0 else (now - self.began_at) / whole_s

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


class Drive:
    """Drive of a virtual arm: its joints, and the path that they are on; the fault `stall` is its own."""

    def __init__(self, joints: Joints, faults: Collection[str]) -> None:
        self.joints = joints
        self.path: Path | None = None
        self._faults = faults

    @property
    def next_deadline(self) -> float:
        return self.path.ends_at if self.path is not None else math.inf

    def is_half_way(self, now: float) -> bool:
        """True on the second half of a path that is not braked."""
        path = self.path
        return path is not None and path.braked_s == math.inf and path.part(now) >= 0.5

    def travel(self, now: float) -> bool:
        """Go on; True where the path has ended."""
        path = self.path
        if path is None or ("stall" in self._faults and path.part(now) >= 0.5):
            return False
        self.joints = path.at(now)
        if path.ends_at <= now:
            self.path = None
        return self.path is None

    def brake(self, now: float) -> None:
        if self.path is not None:
            self.path = self.path.braked(now)
