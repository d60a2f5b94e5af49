"""Plain shapes for a link whose own cannot be drawn: a ball, and a tube to each joint that it carries."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

THICK, LEAST_M, MOST_M = 0.12, 0.015, 0.05  # a tube's radius: a share of its length, and its bounds
SHORT_M = 1e-3  # no tube is drawn for less


def shapes(ends: Iterable[Sequence[float]]) -> list[dict[str, Any]]:
    """The stand-in for a link whose joints are at `ends`, m: {kind, size, xyz, rpy} as in `bodies`."""
    tubes = [_tube(end) for end in ends if math.hypot(*end) > SHORT_M]
    radius = max((tube["size"][0] for tube in tubes), default=LEAST_M)
    ball = {"kind": "sphere", "size": [radius], "xyz": [0.0, 0.0, 0.0], "rpy": [0.0, 0.0, 0.0]}
    return [ball, *tubes]


def _tube(end: Sequence[float]) -> dict[str, Any]:
    x, y, z = end
    length = math.hypot(x, y, z)
    radius = min(max(THICK * length, LEAST_M), MOST_M)
    middle = [value / 2 for value in end]
    rpy = [0.0, math.acos(z / length), math.atan2(y, x)]
    return {"kind": "cylinder", "size": [radius, length], "xyz": middle, "rpy": rpy}
