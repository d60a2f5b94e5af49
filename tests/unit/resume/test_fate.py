"""What became of a command, by the numbers that its board says."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import MotionState, Receipt, Report
from arboleda.resume.walk_back import Fate, fate
from arboleda.testing import shipped

BRIDGE = 1001
GOAL = (0.5, 0.0, 0.0)
MOVE = {
    "effect": "motion",
    "goal": GOAL,
    "sets": (),
    "before": (BRIDGE, 4),
    "number": (BRIDGE, 5),
    "done": False,
}


def become(receipt: Receipt, **kept: Any) -> Fate:
    """What became of command 5, a move unless `kept` says else, as its arm stands at its goal."""
    dispatcher = Dispatcher(shipped("sis_a"), 7, {})
    for at in (1.0, 1.1):
        report = Report(at=at, robot="ra1", state=MotionState.STOPPED, q=GOAL, homed=True, receipt=receipt)
        dispatcher.report(report, at)
    return fate({**MOVE, **kept}, dispatcher.beliefs["ra1"])


def test_a_move_is_done_once_its_number_is_whatever_was_accepted_since() -> None:
    assert become(Receipt(BRIDGE, 5, 5)) is Fate.DONE
    assert become(Receipt(BRIDGE, 6, 5)) is Fate.DONE


@pytest.mark.parametrize("done", [None, 4, 6])
def test_a_move_of_which_another_number_is_done_was_cut_short(done: int | None) -> None:
    assert become(Receipt(BRIDGE, 6, done)) is Fate.CUT_SHORT


def test_a_move_whose_number_was_not_kept_is_the_last_one_accepted() -> None:
    assert become(Receipt(BRIDGE, 5, 5), number=None) is Fate.DONE
    assert become(Receipt(BRIDGE, 6, 5), number=None) is Fate.CUT_SHORT


def test_a_switch_that_sets_no_fact_is_not_done_by_being_untaken() -> None:
    switch = {"effect": "switch", "goal": None, "number": None}
    assert become(Receipt(BRIDGE, 4, 4), **switch) is Fate.UNTAKEN
    assert become(Receipt(BRIDGE, 4, 4), **switch, sets=(("homed", True),)) is Fate.DONE
