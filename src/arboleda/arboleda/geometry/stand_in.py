"""Stand-in for a link whose shapes cannot be drawn: a ball, a tube to each of its joints, and rails.

A sliding joint slides along a rail.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

THICK, LEAST_M, MOST_M = 0.12, 0.015, 0.05  # radius of a tube: share of its length, least and most
NOWHERE = (0.0, 0.0, 0.0)
SHORT_M = 1e-3  # no tube is drawn for less


def shapes(
    ends: Iterable[Sequence[float]], rails: Iterable[tuple[Sequence[float], Sequence[float]]] = ()
) -> list[dict[str, Any]]:
    """The stand-in for a link whose joints are at `ends`, m: {kind, size, xyz, rpy} as in `bodies`.

    `rails` are the two ends of the path of each sliding joint.
    """
    tubes = [_tube(NOWHERE, end) for end in ends if math.hypot(*end) > SHORT_M]
    radius = max((tube["size"][0] for tube in tubes), default=LEAST_M)
    ball = {"kind": "sphere", "size": [radius], "xyz": [0.0, 0.0, 0.0], "rpy": [0.0, 0.0, 0.0]}
    return [ball, *tubes, *(_tube(*rail) for rail in rails if math.dist(*rail) > SHORT_M)]


def rail(
    xyz: Sequence[float], rpy: Sequence[float], axis: Sequence[float], lower: float, upper: float
) -> tuple[list[float], list[float]]:
    """The ends, m, of the rail of a joint that slides along `axis` in the frame at `xyz` and `rpy`."""
    along = _turned(axis, rpy)
    low, high = ([at + by * step for at, step in zip(xyz, along, strict=True)] for by in (lower, upper))
    return low, high


def _turned(axis: Sequence[float], rpy: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = axis
    for angle, turn in zip(rpy, (_about_x, _about_y, _about_z), strict=True):
        x, y, z = turn(x, y, z, math.cos(angle), math.sin(angle))
    return x, y, z


def _about_x(x: float, y: float, z: float, c: float, s: float) -> tuple[float, float, float]:
    return x, c * y - s * z, s * y + c * z


def _about_y(x: float, y: float, z: float, c: float, s: float) -> tuple[float, float, float]:
    return c * x + s * z, y, c * z - s * x


def _about_z(x: float, y: float, z: float, c: float, s: float) -> tuple[float, float, float]:
    return c * x - s * y, s * x + c * y, z


def _tube(start: Sequence[float], end: Sequence[float]) -> dict[str, Any]:
    x, y, z = (b - a for a, b in zip(start, end, strict=True))
    length = math.hypot(x, y, z)
    radius = min(max(THICK * length, LEAST_M), MOST_M)
    middle = [(a + b) / 2 for a, b in zip(start, end, strict=True)]
    rpy = [0.0, math.acos(z / length), math.atan2(y, x)]
    return {"kind": "cylinder", "size": [radius, length], "xyz": middle, "rpy": rpy}
