"""Telemetry of a board as the bridge must understand it, and the report that says the same."""

from __future__ import annotations

import json
import math
from functools import cache
from typing import Any

from arboleda.drivers import Report, Robot

from .boards import parts

EXACT = 1e-9
FOREIGN_TO_ARMS, FOREIGN_TO_MOBILES = ("nodo",), ("efector", "pieza", "q1_mov")
FLAGS = (("homed", "ref"), ("effector", "efector"), ("piece", "pieza"))
SAME = ("state", "q", "node", "homed", "effector", "piece", "boot_id")


class TelemetryReader:
    """Reader of one board's telemetry; what differs from the last only in its number is not decoded again."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        # the last telemetry as it was read: its bytes before its number, if it has one, after it, its fields
        self._last: tuple[bytes, bool, bytes, dict[str, Any]] | None = None

    def fields(self, payload: bytes) -> dict[str, Any] | None:
        """The fields of telemetry; None if the bridge has to refuse it."""
        before, number, after = parts(payload)
        last = self._last
        if last is not None and last[:3] == (before, number != b"", after):
            if number:
                last[3]["seq"] = int(number)
            return last[3]
        fields = read(payload, self._robot)
        if fields is not None and payload.count(b'"seq"') <= 1:
            self._last = (before, number != b"", after, fields)
        return fields


def read(payload: bytes, robot: Robot) -> dict[str, Any] | None:
    """The fields of telemetry; None if it is to be refused, for the reasons that occur in simulations."""
    try:
        fields = json.loads(payload)
    except ValueError:
        return None
    place = _place_keys(len(robot.joints))
    if not isinstance(fields, dict) or len(payload) > 512 or not fields.keys() >= place:
        return None
    if not fields.keys().isdisjoint(FOREIGN_TO_ARMS if robot.joints else FOREIGN_TO_MOBILES):
        return None
    grid = robot.floor_grid
    if grid and not 0 <= fields["nodo"] < grid.size:
        return None
    for key in place:
        if type(fields[key]) not in (int, float) or not math.isfinite(fields[key]):
            return None
    return fields if type(fields.get("estado")) is int and 0 <= fields["estado"] <= 4 else None


def agrees(report: Report, fields: dict[str, Any], robot: Robot) -> bool:
    """True if a report has the state, the place and the flags of this telemetry."""
    for flag, key in FLAGS:
        if getattr(report, flag) != (None if key not in fields else fields[key] == 1):
            return False
    if report.state is None or report.state != fields["estado"]:
        return False
    if not robot.joints:
        return report.node == fields["nodo"] and report.q is None
    if report.q is None or report.node is not None:
        return False
    for number, (joint, value) in enumerate(zip(robot.joints, report.q, strict=True), start=1):
        published = math.radians(fields[f"q{number}_mov"]) * (joint.pinion_radius_m or 1.0)
        if not abs(value - published) < EXACT:
            return False
    return True


def is_same(report: Report, other: Report) -> bool:
    """True if two reports say the same of a robot."""
    return all(getattr(report, name) == getattr(other, name) for name in SAME)


@cache
def _place_keys(joints: int) -> frozenset[str]:
    return frozenset(f"q{number}_mov" for number in range(1, joints + 1)) if joints else frozenset({"nodo"})
