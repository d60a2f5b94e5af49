"""What position and state code prove at `joints`, where either may come up to two telemetry periods late."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.evidence import Before, judge, strayed
from arboleda.dispatch.ledger import Entry, Feed
from arboleda.dispatch.stillness import ReportMoment
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import MotionState, Reason, Report
from arboleda.model.plant_model import APART_S, QUIET_S, Evidence
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout

MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED
CELL = shipped("sis_a", evidence=Evidence.JOINTS).cell("sis_a")
HOME, GOAL, HALFWAY = (StorageLayout(CELL).arm.motion.quantised((q1, 0.0, 0.0)) for q1 in (0.0, 0.2, 0.1))
PERIOD_S = 0.1


class Judged:
    """One command that left at 0 s; its robot stood still at `origin` before, as it said."""

    def __init__(self, command: MoveJoints | FollowPath, origin: Any) -> None:
        robot = StorageLayout(CELL).arm if isinstance(command, MoveJoints) else StorageLayout(CELL).mobile
        self.belief = Belief(robot, 1.5, 1)
        self.key = "q" if isinstance(command, MoveJoints) else "node"
        self._hear(-0.01, state=STOPPED, **{self.key: origin})
        self.entry = Entry(command, cell=CELL.name, doing="moving", sent_at=0.0, deadline=60.0)
        self.entry.origin = self.belief.position
        self.proven: list[tuple[float, Feed, Reason | None]] = []

    def hear(self, at: float, place: Any = None, state: MotionState | None = None) -> None:
        """A report of a position, a state code, or both; nothing is judged once the command has ended."""
        before = self._hear(at, **({} if place is None else {self.key: place}), state=state)
        if self.proven and self.proven[-1][1] is not Feed.ACCEPTED:
            return
        verdict = judge(self.entry, before, self.belief, self.report)
        if verdict is not None:
            self.proven.append((at, verdict.feed, verdict.failure and verdict.failure.reason))

    def stays(self, since: float, until: float, place: Any, state: MotionState | None = None) -> None:
        """The same once every period."""
        for number in range(round((until - since) / PERIOD_S)):
            self.hear(since + number * PERIOD_S, place, state)

    @property
    def end(self) -> Feed | None:
        ended = [feed for _, feed, _ in self.proven if feed is not Feed.ACCEPTED]
        return ended[0] if ended else None

    def _hear(self, at: float, **said: Any) -> Before:
        self.report = Report(at=at, robot=self.belief.robot.name, **said)
        before = Before.of(self.belief)
        self.belief.merge(self.report)
        return before


def move(goal: tuple[float, ...], origin: tuple[float, ...] = HOME) -> Judged:
    return Judged(MoveJoints(id="1-1", robot="ra1", q=goal), origin)


def drive(*nodes: int) -> Judged:
    return Judged(FollowPath(id="1-1", robot="rm_sis_a", nodes=nodes), nodes[0])


def test_a_move_of_no_length_is_not_ended_by_what_was_said_before_it() -> None:
    judged = move(HOME)
    judged.hear(0.01, HOME, STOPPED)
    assert judged.end is None


def test_a_move_of_no_length_of_which_nothing_is_said_is_done_when_it_could_have_been() -> None:
    judged = move(HOME)
    judged.stays(0.05, QUIET_S, HOME)
    assert judged.end is None
    judged.stays(0.05 + QUIET_S, 1.0, HOME)
    assert judged.end is Feed.DONE


def test_a_move_of_no_length_is_done_with_its_own_pulse() -> None:
    judged = move(HOME)
    judged.hear(0.01, HOME)
    judged.hear(0.02, state=MOVING)
    assert judged.end is None
    judged.hear(0.03, state=STOPPED)
    assert judged.end is Feed.DONE


@pytest.mark.parametrize("pulse", [(0.01, 0.02), (0.01, 0.19), (0.15, 0.2)], ids=str)
def test_the_late_pulse_of_an_earlier_move_ends_no_other_one(pulse: tuple[float, float]) -> None:
    judged = move(GOAL)
    moving, stopped = pulse
    judged.hear(0.0, HOME)
    judged.hear(moving, state=MOVING)
    judged.hear(stopped, state=STOPPED)
    judged.stays(0.21, 0.35, HALFWAY)
    judged.hear(0.4, state=MOVING)
    judged.stays(0.41, 0.6, HALFWAY)
    assert judged.end is None
    judged.hear(0.61, GOAL)
    judged.hear(0.7, state=STOPPED)
    assert judged.end is Feed.DONE


def test_an_old_stopped_and_a_new_position_on_the_goal_are_not_the_end() -> None:
    judged = move(GOAL)
    judged.hear(0.1, HALFWAY)
    judged.hear(0.2, GOAL)
    judged.hear(0.3, GOAL)
    assert judged.end is None
    judged.hear(0.39, state=MOVING)
    judged.hear(0.41, state=STOPPED)
    assert judged.end is Feed.DONE


def test_a_robot_that_never_says_moving_is_done_once_it_stays_on_its_goal() -> None:
    judged = move(GOAL)
    judged.hear(0.1, HALFWAY)
    judged.stays(0.2, 0.2 + QUIET_S, GOAL)
    assert judged.end is None
    judged.stays(0.2 + QUIET_S, 1.0, GOAL)
    assert judged.end is Feed.DONE


def test_two_equal_positions_and_a_stop_that_lasts_are_short_of_the_goal() -> None:
    judged = move(GOAL)
    judged.hear(0.1, HALFWAY, MOVING)
    judged.hear(0.2, state=STOPPED)
    judged.stays(0.25, 0.2 + APART_S, HALFWAY)
    assert judged.end is None
    judged.stays(0.2 + APART_S + 0.05, 1.0, HALFWAY)
    assert judged.end is Feed.FAILED
    assert judged.proven[-1][2] is Reason.STOPPED_SHORT
    assert judged.proven[-1][0] >= 0.2 + QUIET_S


def test_a_stop_has_lasted_when_its_time_is_over() -> None:
    judged = move(GOAL)
    judged.hear(0.5, HALFWAY, MOVING)
    judged.hear(1.0, state=STOPPED)
    judged.stays(1.0 + APART_S, 1.0 + APART_S + PERIOD_S, HALFWAY)
    judged.hear(1.0 + APART_S + PERIOD_S / 2, HALFWAY)
    assert judged.end is None
    judged.hear(1.0 + QUIET_S, HALFWAY)
    assert judged.end is Feed.FAILED


def test_other_positions_are_no_stop_whatever_the_code_says() -> None:
    judged = move(GOAL)
    judged.hear(0.1, HALFWAY, MOVING)
    judged.hear(0.2, state=STOPPED)
    for number in range(10):
        judged.hear(0.3 + number * PERIOD_S, tuple(q * number / 20 for q in GOAL))
    assert judged.end is None


def test_who_never_left_its_place_may_have_said_only_the_end_of_an_earlier_move() -> None:
    judged = move(GOAL)
    judged.hear(0.01, HOME, MOVING)
    judged.stays(0.1, 3.0, HOME, STOPPED)
    assert judged.end is None  # by its deadline


@pytest.mark.parametrize(
    ("nodes", "seen", "end"),
    [
        ((0, 3, 0), (0, 0), None),
        ((0, 3, 0), (0, 3, 0), Feed.DONE),
        ((0, 3, 0, 3, 0), (0, 3, 0), None),
        ((0, 3, 0, 3, 0), (3, 0, 3, 0), Feed.DONE),
        ((4, 1, 0, 1), (4, 1), None),
        ((0, 3, 4, 7), (0, 7), Feed.DONE),
        ((4,), (4,), Feed.DONE),
    ],
    ids=str,
)
def test_a_path_that_comes_by_its_end_before_must_be_seen_driven(
    nodes: tuple[int, ...], seen: Iterable[int], end: Feed | None
) -> None:
    judged = drive(*nodes)
    judged.hear(0.01, state=MOVING)
    for number, node in enumerate(seen, start=1):
        judged.hear(number * 1.0, node)
    judged.hear(8.0, state=STOPPED)
    judged.stays(8.01, 8.4, judged.belief.node)
    assert judged.end is not Feed.DONE if end is None else judged.end is end


@pytest.mark.parametrize("nodes", [(0, 3, 0), (3, 0)], ids=str)
def test_a_node_that_is_told_late_after_the_stop_is_not_where_a_robot_stands(nodes: tuple[int, ...]) -> None:
    """It began a node before the one that was thought, so it came by its goal, drove on, and was halted."""
    judged = drive(*nodes)
    judged.hear(0.01, state=MOVING)
    judged.hear(0.5, 3)
    judged.stays(1.5, 2.5, 0)
    judged.hear(2.5, state=STOPPED)
    judged.hear(2.49 + APART_S, 0)
    assert judged.end is None
    judged.stays(2.51 + APART_S, 4.0, 3)
    assert judged.end is not Feed.DONE


def test_a_node_that_is_told_so_long_after_the_stop_is_where_a_robot_stands() -> None:
    judged = drive(3, 0)
    judged.hear(0.5, 3, MOVING)
    judged.hear(2.0, 0)
    judged.hear(2.5, state=STOPPED)
    assert judged.end is None
    judged.hear(2.5 + APART_S, 0)
    assert judged.end is Feed.DONE


def test_a_halt_is_not_proven_by_what_was_said_before_the_robot_heard_it() -> None:
    judged = move(GOAL)
    belief = judged.belief
    moment = ReportMoment(belief.reports, 1.0)
    judged.hear(1.01, HALFWAY, STOPPED)
    judged.hear(1.02, HALFWAY, STOPPED)
    assert not belief.stillness.still_since(moment)
    judged.hear(1.0 + APART_S, HALFWAY, STOPPED)
    assert not belief.stillness.still_since(moment)
    judged.hear(1.1 + APART_S, HALFWAY)
    assert belief.stillness.still_since(moment)


def test_a_halt_is_not_proven_by_nodes_that_may_be_from_before_the_robot_stopped() -> None:
    """It is halted on an edge, at whose end it stops; on the way there it tells one node all the time."""
    judged = drive(0, 3)
    belief = judged.belief
    moment = ReportMoment(belief.reports, 1.0)
    judged.stays(1.01, 1.5, 0, MOVING)
    judged.hear(1.5, state=STOPPED)
    judged.hear(1.507, 0)
    assert not belief.stillness.still_since(moment)
    judged.stays(1.6, 1.8, 3)
    assert not belief.stillness.still_since(moment)
    judged.stays(1.8, 2.0, 3)
    assert belief.stillness.still_since(moment)


@pytest.mark.parametrize(("place", "is_astray"), [(HALFWAY, True), (GOAL, False)])
def test_who_is_elsewhere_than_it_had_come_to_after_a_silence_has_strayed(
    place: tuple[float, ...], is_astray: bool
) -> None:
    belief = Belief(StorageLayout(CELL).arm, 1.5, 1)
    report = Report(at=9.0, robot="ra1", q=place, state=STOPPED)
    belief.merge(report)
    assert strayed(belief, report, GOAL) is is_astray
