"""What a dispatcher sends, and what it refuses to send."""

from __future__ import annotations

from functools import partial

import pytest

from arboleda.core.dispatcher import Dispatcher
from arboleda.core.ledger import State
from arboleda.core.messages import Home, Reason, Report, SetEffector
from arboleda.core.model import MotionState
from arboleda.testing import shipped

EPOCH = 7


@pytest.fixture
def latched() -> Dispatcher:
    """An arm that stands still, and that an operator has stopped."""
    dispatcher = Dispatcher(shipped("sis_a"), EPOCH, {})
    said = Report(at=100.0, robot="ra1", state=MotionState.STOPPED, q=(0.0, 0.0, 0.0), homed=True)
    dispatcher.report(said, 100.0)
    dispatcher.latch("ra1")
    return dispatcher


@pytest.mark.parametrize("make", [partial(SetEffector, on=True), Home], ids=["effector", "home"])
def test_a_stopped_robot_is_sent_nothing_by_a_task(latched: Dispatcher, make: type) -> None:
    entry = latched.send(partial(make, robot="ra1"), "sis_a", "doing", 100.1)
    assert entry.state is State.FAILED and entry.failure and entry.failure.reason is Reason.STOPPED


def test_a_stopped_robot_lets_its_part_go_by_hand(latched: Dispatcher) -> None:
    let_go = partial(SetEffector, robot="ra1", on=False)
    assert latched.send(let_go, "sis_a", "doing", 100.1, by_hand=True).failure is None
