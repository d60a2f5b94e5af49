"""Where robots are and when they spoke, out of what they report."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState

FRESH_S = 1.0  # a robot that reports as often as that says nothing new by when it spoke last
DIGITS = 6  # of rad and m
Row = dict[str, Any]


def key_of(robot: str) -> str:
    """The key of a robot's row."""
    return f"motion/{robot}"


class Motion:
    """A row for each robot: q, node, when it spoke (`heard_at`) and said where it is (`position_at`), in s of
    the plant's clock; `fresh` names those of the two that are less than FRESH_S ago, and left out.
    """

    def __init__(self) -> None:
        self._known: dict[str, Row] = {}

    def seen(self, robot: Row) -> None:
        """Take over what the twin's positions say of a robot."""
        self._known[robot["name"]] = {key: robot[key] for key in ("q", "node", "heard_at", "position_at")}

    def hear(self, report: Report) -> None:
        """Take over what a robot reports, once it was seen."""
        known = self._known.get(report.robot)
        if known is None:
            return
        if report.state is not MotionState.NO_LINK:
            known["heard_at"] = report.at
        for key in ("q", "node"):
            if (said := getattr(report, key)) is not None:
                known[key], known["position_at"] = said, report.at

    def rows(self, now: float) -> Iterator[tuple[str, Row]]:
        """Key and row of each robot that was seen."""
        for name, known in self._known.items():
            yield key_of(name), _row(known, now)


def _row(known: Row, now: float) -> Row:
    times = {key: known[key] for key in ("heard_at", "position_at")}
    fresh = [key for key, at in times.items() if at is not None and now - at < FRESH_S]
    old = {key: None if key in fresh or at is None else round(at, 1) for key, at in times.items()}
    q = known["q"] and [round(value, DIGITS) for value in known["q"]]
    return {"q": q, "node": known["node"], **old, "fresh": fresh}
