"""Work that stopped short of its target says what was late; the next deadline of a plant is worked out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import MotionState, Reason
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import OWN
from arboleda.testing import shipped
from arboleda_bench.obedient import Yard, command_in, is_over
from arboleda_bench.step import begin_task, go_on

MOVING, STILL = MotionState.MOVING, MotionState.STOPPED
ON_THE_WAY = (
    "it was heard, and heartbeats left in time: they came late on their way, or something else stopped it"
)


@pytest.fixture
def arm_moves(hand: Callable[[Evidence], Any]) -> Any:
    """A plant whose arm has just taken its move to the pick-up."""
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.submit("sis_a 0B 7")
    plant.wait(0.2)
    (path,) = plant.commands(FollowPath)
    plant.tell("rm_sis_a", state=STILL, node=7, accepted=path.id, done=path.id)
    plant.tell("ra1", state=STILL)
    (move,) = plant.commands(MoveJoints)
    plant.tell("ra1", state=MOVING, accepted=move.id)
    return plant


def why_short(plant: Any, after: float = 0.05) -> str:
    """The end of the sentence on the move, once the arm has stopped on its way."""
    (move,) = plant.commands(MoveJoints)
    entry = plant.plant.dispatcher.ledger.entries[move.id]
    plant.tell("ra1", after=after, state=STILL, q=(0.3, 0.0, 0.0), accepted=move.id)
    assert entry.failure is not None and entry.failure.reason is Reason.STOPPED_SHORT
    what, _, why = str(entry.failure.sentence).partition("pick-up: ")
    assert what == "ra1: stopped before its target while moving to "
    return why


def test_a_plant_that_sent_no_heartbeat_in_time_says_so(arm_moves: Any) -> None:
    arm_moves.wait(arm_moves.plant.next_deadline - arm_moves.now)
    arm_moves.now += 0.9
    arm_moves.tell("ra1", after=0.0, state=MOVING)
    why = why_short(arm_moves)
    assert why == "the plant sent no heartbeat for 0.9 s, and a board stops after 1 s without one"


def test_a_robot_that_was_not_heard_in_time_is_late_itself(arm_moves: Any) -> None:
    why = why_short(arm_moves, after=0.9)
    assert why == "nothing was heard of it for 0.9 s: its board, network or broker was late"


def test_where_all_was_in_time_here_it_was_late_on_its_way(arm_moves: Any) -> None:
    for _ in range(10):
        arm_moves.tell("ra1", after=0.2, state=MOVING)
    assert why_short(arm_moves) == ON_THE_WAY


def test_what_was_late_before_the_move_did_not_stop_it(arm_moves: Any) -> None:
    arm_moves.plant.dispatcher.beat_pauses.note(arm_moves.now - 5.0, 0.9)
    assert why_short(arm_moves) == ON_THE_WAY


def test_where_somebody_else_commanded_it_nothing_was_late(arm_moves: Any) -> None:
    other = OWN(text="somebody else commanded ra1")
    arm_moves.plant.dispatcher.interfere("ra1", other, arm_moves.now, obeyed=True)
    (move,) = arm_moves.commands(MoveJoints)
    entry = arm_moves.plant.dispatcher.ledger.entries[move.id]
    arm_moves.tell("ra1", state=STILL, q=(0.3, 0.0, 0.0), accepted=move.id)
    assert str(entry.failure.sentence).endswith("pick-up; somebody else commanded ra1")


def played(yard: Yard, *, asks: bool) -> tuple[list[Any], list[float]]:
    """All that a plant sends for one task, and its deadlines where it is asked for them."""
    out = begin_task(yard)
    sent, deadlines = [*out], list[float]()
    while not is_over(out):
        out = go_on(yard, command_in(out))
        sent += out
        if asks:
            deadlines.append(yard.plant.next_deadline)
    return sent, [*deadlines, yard.plant.next_deadline]


def test_a_plant_that_is_not_asked_for_its_deadline_does_the_same() -> None:
    asked, unasked = (played(Yard(shipped("sis_a")), asks=asks) for asks in (True, False))
    assert asked[0] == unasked[0] and len(asked[0]) > 10
    assert asked[1][-1] == unasked[1][-1]
