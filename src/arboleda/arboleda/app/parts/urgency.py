"""Which reports the plant must look at now, and which may wait a moment for others."""

from __future__ import annotations

from dataclasses import fields
from operator import attrgetter

from arboleda.core.messages import Report
from arboleda.core.model import Evidence, MotionState
from arboleda.core.plant import Plant

COMPANY_S = 0.02  # a fifth of a telemetry period, too short to be seen in the twin
POSITION = frozenset({"q", "node"})
_words = attrgetter(*(each.name for each in fields(Report) if each.name not in {"at", *POSITION}))


class Urgency:
    """How long a report may wait; asked from the one thread that brings reports, beside the plant's.

    A board that has nothing new to say says so ten times a second. Where a position alone proves nothing, at
    evidence `ids`, such a report may wait; but not while its robot stands still under an open command, whose
    end two equal positions may be, nor while a tree awaits the piece sensor.
    """

    def __init__(self, plant: Plant) -> None:
        self._ledger = plant.dispatcher.ledger
        self._said: dict[str, tuple[object, ...]] = {}
        self._contexts = {
            robot.name: run.context
            for run in plant.cells.values()
            for robot in run.cell.robots
            if robot.evidence is Evidence.IDS
        }

    def within_s(self, report: Report) -> float:
        """0 for news."""
        robot, words = report.robot, _words(report)
        if words != self._said.get(robot):
            self._said[robot] = words
            return 0.0
        context = self._contexts.get(robot)
        if context is None or (context.awaits_piece and report.piece is not None):
            return 0.0
        may_end = report.state is not MotionState.MOVING and self._ledger.of_robot(robot)
        return 0.0 if may_end else COMPANY_S
