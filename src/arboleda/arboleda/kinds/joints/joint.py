"""Joint of a robot: its limits, its motor steps, and the time of its moves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Axis: position in rad (revolute) or m (prismatic); `step` is one motor step in that unit."""

    name: str
    lower: float
    upper: float
    speed: float
    acceleration: float
    step: float
    pinion_radius_m: float | None = None  # None: revolute; else the rack pinion of a prismatic axis
    up: int = -1  # the lifting direction of a prismatic axis: -1 smaller values, 1 greater ones, 0 none

    @property
    def unit(self) -> str:
        return "rad" if self.pinion_radius_m is None else "m"

    def steps(self, value: float) -> int:
        """The whole motor step nearest to `value`, halves away from zero."""
        return math.floor(abs(value) / self.step + 0.5) * (1 if value >= 0 else -1)

    def quantised(self, value: float) -> float:
        """`value` as the motor can hold it."""
        return self.steps(value) * self.step

    def within(self, value: float) -> float:
        """`value`, or the limit that it is beyond, as the motor step nearest to a limit may be."""
        return min(max(value, self.lower), self.upper)

    def at_rate(self, rate: float) -> Joint:
        return replace(self, speed=self.speed * rate, acceleration=self.acceleration * rate**2)

    @property
    def lifts(self) -> bool:
        """True for a prismatic axis that moves up and down."""
        return self.pinion_radius_m is not None and self.up != 0

    def higher(self, value: float, *others: float) -> float:
        """The highest of these values if the joint lifts, else `value`."""
        if not self.lifts:
            return value
        return min(value, *others) if self.up < 0 else max(value, *others)

    def travel_s(self, distance: float) -> float:
        """Time of a rest-to-rest move over `distance` with constant acceleration."""
        distance = abs(distance)
        ramp = self.speed**2 / self.acceleration
        if distance < ramp:
            return 2 * math.sqrt(distance / self.acceleration)
        return distance / self.speed + self.speed / self.acceleration
