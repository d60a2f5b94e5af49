"""Estimate of a robot's position from the last known one and its goal; never beyond the goal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

Position = Sequence[float]


def towards(start: Position, goal: Position, speeds: Position, seconds: float) -> list[float]:
    """The position after so many seconds, every joint on its own way at its own full speed (rad/s, m/s)."""
    rows = zip(start, goal, speeds, strict=True)
    return [_nearer(here, there, speed * max(0.0, seconds)) for here, there, speed in rows]


def along(points: Sequence[Position], speed: float, seconds: float) -> list[float]:
    """The point after so many seconds on straight pieces at one speed, m/s; ValueError without points."""
    if not points:
        raise ValueError("a way has at least one point")
    left = speed * max(0.0, seconds)
    for here, there in pairwise(points):
        length = math.dist(here, there)
        if left < length:
            return [a + (b - a) * left / length for a, b in zip(here, there, strict=True)]
        left -= length
    return list(points[-1])


def apart(a: Position, b: Position, speeds: Position, seconds: float) -> bool:
    """True if two positions are further apart, in any joint, than so many seconds at full speed."""
    rows = zip(a, b, speeds, strict=True)
    return any(abs(here - there) > speed * seconds for here, there, speed in rows)


def _nearer(here: float, there: float, most: float) -> float:
    return there if abs(there - here) <= most else here + math.copysign(most, there - here)
