"""What became of a command, by the numbers that its board says, and which commands explain them."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import MotionState, Receipt, Report
from arboleda.resume.trail import Knowledge
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


SENDER, LATER = 1001, 1004


@pytest.mark.parametrize(
    ("before", "more", "now", "explained"),
    [
        (None, 0, None, True),
        (None, 1, Receipt(SENDER, 1), True),
        (None, 1, Receipt(SENDER, 2), False),
        (None, 1, Receipt(LATER, 1), False),  # given by a start of which nothing is left
        (Receipt(SENDER, 3), 0, Receipt(SENDER, 3), True),
        (Receipt(SENDER, 3), 1, Receipt(SENDER, 4), True),
        (Receipt(SENDER, 3), 1, Receipt(SENDER, 5), False),
        (Receipt(SENDER, 3), 1, Receipt(LATER, 1), False),
        (Receipt(900, 3), 1, Receipt(SENDER, 1), True),  # the first one by this start of the bridge
        (Receipt(900, 3), 1, Receipt(900, 4), True),  # a board that has heard a higher epoch keeps it
        (Receipt(SENDER, 3), 1, None, False),
    ],
)
def test_only_commands_that_were_under_way_by_the_same_bridge_explain_it(
    before: Receipt | None, more: int, now: Receipt | None, explained: bool
) -> None:
    assert Knowledge(boot=1, receipt=before, more=more, bridge=SENDER).explains(now) is explained
