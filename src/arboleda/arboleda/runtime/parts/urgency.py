"""Urgency of reports: some the plant must look at now, others may wait a moment for more."""

from __future__ import annotations

from dataclasses import fields
from operator import attrgetter

from arboleda.engine import Plant
from arboleda.model.cell_states import CellState
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence

COMPANY_S = 0.02  # a fifth of a telemetry period, too short to be seen in the twin
RESTING_S = 0.25  # the plant steps as often by itself, to beat
PASSING = frozenset({CellState.HOLDING, CellState.ABORTING, CellState.CLEARING, CellState.RESETTING})
POSITION = frozenset({"q", "node"})
_words = attrgetter(*(each.name for each in fields(Report) if each.name not in {"at", "robot", *POSITION}))
_NOTHING = _words(Report(at=0.0, robot=""))


class Urgency:
    """Urgency: decides how long a report may wait, in the one thread that brings reports, beside the plant's.

    A robot without news says so ten times a second. If a position alone proves nothing, such a report may
    wait: but not while its robot stands still under an open command, which a position may end, nor while a
    tree awaits the piece sensor. At evidence `joints`, position and state come one by one. While nothing goes
    on in its cell, a report that repeats the last one in every word may wait longer.
    """

    def __init__(self, plant: Plant) -> None:
        self._ledger = plant.dispatcher.ledger
        self._last_words: dict[str, tuple[object, ...]] = {}
        self._state: dict[str, MotionState] = {}
        self._last: dict[str, Report] = {}
        self._runs = {
            robot.name: run
            for run in plant.cells.values()
            for robot in run.cell.robots
            if robot.evidence is not Evidence.STATE
        }

    def within_s(self, report: Report) -> float:
        """The time that a report may wait, s; 0 for news."""
        robot = report.robot
        if report.state is not None:
            self._state[robot] = report.state
        last, self._last[robot] = self._last.get(robot), report
        if self._is_news(report):
            return 0.0
        repeats = last is not None and report.words == last.words
        run = self._runs.get(robot)
        if run is None or (run.context.sensors.awaited and report.piece is not None):
            return 0.0
        may_end = self._state.get(robot) is not MotionState.MOVING and self._ledger.of_robot(robot)
        if may_end or run.state in PASSING:
            return 0.0
        return RESTING_S if repeats and run.tree is None and not run.queue else COMPANY_S

    def _is_news(self, report: Report) -> bool:
        """True if a report says more than the robot's position, and something else than the one before."""
        words = _words(report)
        if words == _NOTHING or words == self._last_words.get(report.robot):
            return False
        self._last_words[report.robot] = words
        return True
