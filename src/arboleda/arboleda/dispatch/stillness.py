"""Stillness of one robot: since when it surely stands, and whether its place may be older than its stop."""

from __future__ import annotations

import math
from typing import NamedTuple

from arboleda.model.commands import Position
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import APART_S, Evidence, Robot

STILL = frozenset({MotionState.STOPPED, MotionState.STOP_LATCHED, MotionState.NOT_HOMED})


class ReportMoment(NamedTuple):
    """Moment in a robot's reports: the number of reports until then, and s of the plant's clock."""

    reports: int
    at: float


class Stillness:
    """Standing still of a robot, by its reports. Their numbers tell them apart, as two may come at one time.

    `is_sure`: its place is no older than its last stop. A device that goes nowhere has facts for a place.
    """

    def __init__(self, robot: Robot, *, supervised: bool) -> None:
        self.is_sure = True
        self.position_at = 0.0
        self._robot = robot
        self._supervised = supervised
        self._position_no = 0
        self._told_at = 0.0  # when its place, or its facts, came last
        self._sure_from = -math.inf
        self._says_still = False  # by its last state code
        self._state_no = 0
        self._state_at = 0.0
        self._still_from = 0  # the number of the first of two still codes in a row
        self._rested_from = 0  # the number of the first of two equal positions in a row
        self._rested_at = 0.0

    def hear(self, report: Report, number: int, position: Position | None, before: Position | None) -> None:
        """Take over a report by its number, its position, and the position of the report before."""
        if report.state is MotionState.NO_LINK:
            self._says_still = False
        elif report.state is not None:
            still = report.state in STILL
            self._still_from = self._state_no if still and self._says_still else 0
            self._says_still = still
            self._state_no, self._state_at = number, report.at
        if position is not None:
            moved = position != before or not self._rested_from
            self._rested_from = number if moved else self._position_no
            self._rested_at = report.at if moved else self.position_at
            self._position_no = number
        if report.q is not None or report.node is not None:
            self.position_at = report.at
        if position is not None or (report.facts and not self._robot.goes):
            self._told_at = report.at
        self.is_sure = self._told_at >= self._sure_from

    @property
    def is_still(self) -> bool:
        """True where its last two reports say that it stands still."""
        return self.still_since(ReportMoment(0, -math.inf))

    def rested_since(self, at: float) -> bool:
        """True where it reported one position at least twice from `at` on, and no other since."""
        return self._rested_from < self._position_no and self._rested_at >= at

    def still_since(self, moment: ReportMoment) -> bool:
        """True where it surely stands still: a still code and two equal positions, all after that moment.

        A device without a position has to say twice that it is still; one without work always stands.

        At `joints`, code and position are of two instants that may come `APART_S` apart. So both have to be
        younger than the moment by that, and the positions younger than the stop: on an edge between two nodes
        a robot reports one node all the time, so two equal positions from before the stop prove nothing.
        """
        count, at = moment
        if not self._robot.works:
            return True
        if not self._says_still or self._state_no <= count:
            return False
        if self._robot.evidence is Evidence.JOINTS and self._state_at < at + APART_S:
            return False
        if not self._supervised:
            return True
        if self._robot.position_key is None:
            return count < self._still_from
        rested = count < self._rested_from < self._position_no
        if self._robot.evidence is Evidence.IDS:
            return rested
        return rested and self.rested_since(max(at + APART_S, self._sure_from))

    def come_to_a_stop(self, at: float) -> None:
        """Note that it may have stopped just now, so that its place is told a little later."""
        self._sure_from = at + APART_S

    def find_again(self, said: MotionState | None) -> None:
        """Take what it `said` before its link was lost for its last state code, from when it came."""
        self._says_still = said in STILL

    def doubt(self, until: float) -> None:
        """Take its reports of a place before that time for older than its last move."""
        self._sure_from, self.is_sure = until, False

    def be_sure(self) -> None:
        """Take its reports for no older than its last stop, since it has proven a command."""
        self._sure_from, self.is_sure = -math.inf, True
