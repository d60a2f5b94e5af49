"""One robot over time: its measured, its estimated and its outdated positions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

Row = dict[str, Any]
Position = Sequence[float]
SEEN_APART_S = 0.03  # an estimate that is nearer to what was measured is not drawn beside it
MEASURED, ESTIMATED, STALE, UNHOMED, UNKNOWN = KINDS = (
    "measured",
    "estimated",
    "stale",
    "unhomed",
    "unknown",
)


class Track:
    """Track: turns a robot's rows of `views.twin_view.positions` and the plant's time, s, into what is drawn.

    It returns {kind, q, estimate, goal, age}: `q` is the last reported position, `estimate` the likely one by
    now, `goal` the end of its open move, `age` the whole s since the last report of a robot that is silent.
    Each may be None.
    """

    def __init__(self, robot: Row) -> None:
        self._nodes: list[list[float]] | None = robot.get("nodes")
        self._speeds: list[float] = robot["speeds"]
        self._guess: list[float] | None = None  # of a robot that reports no position
        self._start: list[float] | None = None
        self._going: Row | None = None
        self._node: int | None = None
        self._node_since = 0.0

    def see(self, row: Row, now: float) -> Row:
        drawn = self._reporting(row, now) if row["reports"] else self._silent(row, now)
        return {"estimate": None, "age": None, "goal": self._end(row["goal"]), **drawn}

    def _reporting(self, row: Row, now: float) -> Row:
        self._note_node(row, now)
        q = self._position(row)
        if q is None:
            return {"kind": UNKNOWN, "q": None}
        if not row["online"]:
            return {"kind": STALE, "q": q, "age": int(now - row["position_at"])}
        if not row["homed"]:
            return {"kind": UNHOMED, "q": q}
        self._guess = q
        ahead = self._ahead(row, q, now)
        shown = ahead is not None and apart(q, ahead, self._speeds, SEEN_APART_S)
        return {"kind": MEASURED, "q": q, "estimate": ahead if shown else None}

    def _silent(self, row: Row, now: float) -> Row:
        """The drawing of a robot that only says whether it moves."""
        if row["reached"] is not None:
            self._guess = self._position({"q": None, "node": None, **row["reached"]})
        if row["goal"] != self._going:
            self._going, self._start = row["goal"], self._guess
        if row["goal"] is not None and self._start is not None and row["going_since"] is not None:
            self._guess = self._on_the_way(row["goal"], self._start, now - row["going_since"])
        if self._guess is None:
            return {"kind": UNKNOWN, "q": None}
        if not row["online"]:
            return {"kind": STALE, "q": self._guess, "age": self._silence(row, now)}
        return {"kind": ESTIMATED, "q": None, "estimate": self._guess}

    def _silence(self, row: Row, now: float) -> int | None:
        return None if row["heard_at"] is None else int(now - row["heard_at"])

    def _on_the_way(self, goal: Row, start: list[float], seconds: float) -> list[float]:
        if self._nodes is None:
            return towards(start, goal["q"], self._speeds, seconds)
        points = [start, *(self._nodes[node] for node in goal["nodes"])]
        return along(points, self._speeds[0], seconds)

    def _ahead(self, row: Row, q: list[float], now: float) -> list[float] | None:
        """The estimated position of a robot that reports, some time after its last report; a mobile gets at
        most to its next node."""
        goal, since = row["goal"], row["going_since"]
        if goal is None or since is None:
            return None
        if self._nodes is None:
            return towards(q, goal["q"], self._speeds, now - max(since, row["position_at"]))
        seconds = now - max(since, self._node_since)
        return along([q, *self._next(goal["nodes"])], self._speeds[0], seconds)

    def _next(self, way: list[int]) -> list[list[float]]:
        """The node after the one where it stands, in a list; empty at the end of its way and beside it."""
        assert self._nodes is not None
        after = way[way.index(self._node) + 1 :] if self._node in way else []
        return [self._nodes[node] for node in after[:1]]

    def _note_node(self, row: Row, now: float) -> None:
        if row["node"] != self._node:
            self._node, self._node_since = row["node"], now

    def _position(self, row: Row) -> list[float] | None:
        if self._nodes is None:
            return None if row["q"] is None else list(row["q"])
        return None if row["node"] is None else self._nodes[row["node"]]

    def _end(self, goal: Row | None) -> list[float] | None:
        if goal is None:
            return None
        return goal["q"] if self._nodes is None else self._nodes[goal["nodes"][-1]]


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
