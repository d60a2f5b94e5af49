"""Positions of robots over time, and the times of their reports."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from arboleda.model.messages import MotionState, Report

FRESH_S = 1.0  # a report of less age is fresh: its exact time is left out
DIGITS = 6  # of rad and m
Row = dict[str, Any]


def key_of(robot: str) -> str:
    """The key of a robot's row."""
    return f"motion/{robot}"


class Motion:
    """Positions of robots, a row each: q, node, and the times of the last report and of the last position.

    These times, `heard_at` and `position_at`, are in s of the plant's clock. Those less than FRESH_S ago are
    named in `fresh`, and left out.
    """

    def __init__(self) -> None:
        self._known: dict[str, Row] = {}
        self._restless: set[str] = set()  # robots whose rows may be others than at the last look at news

    def take(self, robot: Row) -> None:
        """Take over the twin's positions of a robot."""
        self._known[robot["name"]] = {key: robot[key] for key in ("q", "node", "heard_at", "position_at")}
        self._restless.add(robot["name"])

    def hear(self, report: Report) -> None:
        """Take over a report of a robot, once it is in the twin."""
        known = self._known.get(report.robot)
        if known is None:
            return
        self._restless.add(report.robot)
        if report.state is not MotionState.NO_LINK:
            known["heard_at"] = report.at
        for key in ("q", "node"):
            if (value := getattr(report, key)) is not None:
                known[key], known["position_at"] = value, report.at

    def rows(self, now: float) -> Iterator[tuple[str, Row]]:
        """The key and row of each robot in the twin."""
        for name, known in self._known.items():
            yield key_of(name), _row(known, now)

    def news(self, now: float) -> Iterator[tuple[str, Row]]:
        """The same of those robots only that reported since the last news, or had a fresh time then."""
        for name in [each for each in self._known if each in self._restless]:
            row = _row(self._known[name], now)
            if not row["fresh"]:
                self._restless.discard(name)
            yield key_of(name), row


def _row(known: Row, now: float) -> Row:
    times = {key: known[key] for key in ("heard_at", "position_at")}
    fresh = [key for key, at in times.items() if at is not None and now - at < FRESH_S]
    old = {key: None if key in fresh or at is None else round(at, 1) for key, at in times.items()}
    q = known["q"] and [round(value, DIGITS) for value in known["q"]]
    return {"q": q, "node": known["node"], **old, "fresh": fresh}
