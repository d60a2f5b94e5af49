"""A rounded outline around points of a plane."""

from __future__ import annotations

import math
from collections.abc import Sequence

Spot = tuple[float, float]
CORNERS = 16  # of the circle around each point


def hull(points: Sequence[Spot], margin: float) -> list[list[float]]:
    """The convex outline, counterclockwise, that keeps `margin` from every point; empty without points."""
    turns = [2 * math.pi * corner / CORNERS for corner in range(CORNERS)]
    around = {
        (round(x + margin * math.cos(angle), 9), round(y + margin * math.sin(angle), 9))
        for x, y in points
        for angle in turns
    }
    inside_out = sorted(around)
    lower, upper = _half(inside_out), _half(inside_out[::-1])
    return [list(point) for point in lower[:-1] + upper[:-1]]


def _half(points: list[Spot]) -> list[Spot]:
    corners: list[Spot] = []
    for point in points:
        while len(corners) > 1 and _turns_right(corners[-2], corners[-1], point):
            corners.pop()
        corners.append(point)
    return corners


def _turns_right(a: Spot, b: Spot, c: Spot) -> bool:
    """True if the line a, b, c does not turn left at b."""
    return (b[0] - a[0]) * (c[1] - a[1]) <= (b[1] - a[1]) * (c[0] - a[0])
