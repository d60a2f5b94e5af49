"""The stop latch: refuses what moves or grips, and is told again to a board that comes back."""

from __future__ import annotations

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import MotionState
from arboleda.wire.bridge import Leaving
from arboleda.wire.payloads import EffectorGoal, StopGoal

EPOCH = 1_000


def stop(mode: StopMode, id: str = "") -> Stop:
    return Stop(id=id, robot="ra1", mode=mode)


def paro(seq: int, epoch: int = EPOCH) -> list:
    return [("ra_1/paro", StopGoal(mode=StopMode.LATCH, seq=seq, epoch=epoch))]


@pytest.fixture
def stopped(linked):
    linked.order(stop(StopMode.LATCH))
    return linked


@pytest.mark.parametrize(
    "command",
    [
        MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.0, 0.0)),
        Home(id="7-1", robot="ra1"),
        SetEffector(id="7-1", robot="ra1", on=True),
    ],
    ids=lambda command: type(command).__name__,
)
def test_while_latched_nothing_may_move_or_grip(stopped, sent, reports, command: Command) -> None:
    out = stopped.order(command)
    assert sent(out) == []
    assert [(report.rejected, report.refusal) for report in reports(out)] == [("7-1", "paro")]


def test_while_latched_the_effector_may_still_open(stopped, sent) -> None:
    out = stopped.order(SetEffector(id="7-1", robot="ra1", on=False))
    assert sent(out) == [("ra_1/efector", EffectorGoal(on=False, seq=2, epoch=EPOCH, heard=1))]


def test_the_latch_of_one_robot_is_not_the_latch_of_another(stopped, sent) -> None:
    assert len(sent(stopped.order(Home(id="7-1", robot="rm_sis_a")))) == 2


def test_clear_lets_goals_through_again(stopped, sent) -> None:
    assert sent(stopped.order(stop(StopMode.CLEAR))) == [
        ("ra_1/paro", StopGoal(mode=StopMode.CLEAR, seq=2, epoch=EPOCH))
    ]
    assert len(sent(stopped.order(Home(id="7-1", robot="ra1")))) == 2


def test_a_bridge_that_leaves_halts_what_moves(linked, sent) -> None:
    linked.order(MoveJoints(id="7-1", robot="ra1", q=(0.5, 0.0, 0.0)))
    halt = [("ra_1/paro", StopGoal(mode=StopMode.HALT, seq=2, epoch=EPOCH))]
    assert sent(linked.step(Leaving(at=linked.now))) == halt
    assert sent(linked.step(Leaving(at=linked.now))) == []


def test_a_bridge_that_leaves_says_nothing_to_boards_at_rest(linked, sent) -> None:
    assert sent(linked.step(Leaving(at=linked.now))) == []


def test_a_halt_latches_nothing(linked, sent) -> None:
    linked.order(stop(StopMode.HALT))
    assert len(sent(linked.order(Home(id="7-1", robot="ra1")))) == 2


def test_the_stop_is_repeated_at_a_new_boot(stopped, sent) -> None:
    assert sent(stopped.tell(boot_id=2, seq=1)) == paro(2)
    assert sent(stopped.tell()) == []


def test_the_stop_is_repeated_when_the_board_comes_back(stopped, sent) -> None:
    stopped.presence(False)
    assert sent(stopped.presence(True)) == []
    assert sent(stopped.tell()) == paro(2)


def test_the_stop_is_repeated_at_a_new_presence(stopped, sent) -> None:
    assert sent(stopped.presence(True)) == paro(2)


def test_a_stop_for_an_absent_robot_waits_for_it(bench, sent, reports) -> None:
    (report,) = reports(bench.order(stop(StopMode.LATCH, id="7-1")))
    assert (report.rejected, report.refusal) == ("7-1", "no_link")
    bench.connect()
    assert sent(bench.tell(ack_epoch=EPOCH + 5)) == paro(1, EPOCH + 6)


def test_a_cleared_stop_is_not_repeated(stopped, sent) -> None:
    stopped.order(stop(StopMode.CLEAR))
    assert sent(stopped.tell(boot_id=2, seq=1, state=MotionState.NOT_HOMED, homed=False)) == []
