"""An effector that opens unbidden while it carries has lost its part, with or without a piece sensor."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.core import reasons
from arboleda.kinds.arm import SetEffector
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Interference, Reason, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.rig import Rig
from arboleda.testing import shipped

TASK = "sis_a 0B 4"
STEPS = ("grip/try 1/effector on/dwell", "move to station 4")


@pytest.fixture
def rig() -> Rig:
    made = Rig(shipped("sis_a", evidence=Evidence.IDS))
    made.wait(2.0)
    made.submit(TASK)
    return made


def the_end(rig: Rig) -> Any:
    (change,) = rig.outcomes().values()
    return change


@pytest.mark.parametrize("step", STEPS)
def test_the_task_fails_and_says_that_nobody_of_ours_commanded_it(rig: Rig, step: str) -> None:
    rig.wait_for("sis_a", f"main/{step}")
    rig.manual.open_effector("ra_1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert (the_end(rig).state.value, the_end(rig).reason) == ("failed", Reason.PART_LOST)
    assert "not commanded by this plant" in str(the_end(rig).sentence)
    assert rig.plant.cells["sis_a"].state is CellState.IDLE
    ons = [each.on for each in rig.sent if isinstance(each, SetEffector)]
    assert ons == [True], "nothing is left to carry back"


@pytest.mark.parametrize(("ago_s", "named"), [(1.0, True), (6.0, False)])
def test_what_another_node_sent_is_named_only_where_it_was_obeyed_lately(
    rig: Rig, *, ago_s: float, named: bool
) -> None:
    rig.wait_for("sis_a", "main/move to station 4")
    sent = "ra1: effector_cmd 0 of /teleop was sent to it"
    rig.tell(Interference(at=rig.now - ago_s, robot="ra1", sentence=sent))
    rig.manual.open_effector("ra_1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert (sent in str(the_end(rig).sentence)) is named


def test_the_next_task_is_done(rig: Rig) -> None:
    rig.wait_for("sis_a", "main/move to station 4")
    rig.manual.open_effector("ra_1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    task = rig.submit(f"{TASK} #again").task
    assert rig.wait(90.0, until=lambda: rig.outcomes()[task].state.value == "done")


def test_a_part_is_lost_as_ever_after_a_task_was_abandoned(rig: Rig) -> None:
    rig.wait_for("sis_a", "main/drive path 0B")
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(3.0)
    assert rig.operate(Verb.ABANDON, "sis_a") is None
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    task = rig.submit(f"{TASK} #again").task
    assert rig.operate(Verb.RESUME, "sis_a") is None
    rig.wait_for("sis_a", "main/move to station 4")
    rig.manual.open_effector("ra_1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert rig.outcomes()[task].reason is Reason.PART_LOST


def test_an_effector_that_opens_while_the_task_is_held_leaves_nothing_to_go_on_with(rig: Rig) -> None:
    rig.wait_for("sis_a", "main/move to station 4")
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(3.0)
    rig.manual.open_effector("ra_1")
    rig.wait(1.0)
    held = rig.plant.cells["sis_a"]
    assert "ra1 has no part to go on with: abandon sis_a" in str(reasons.of_hold(held))
    assert rig.operate(Verb.RESUME, "sis_a") and rig.operate(Verb.RETRY, "sis_a")
    assert rig.operate(Verb.ABANDON, "sis_a") is None
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert the_end(rig).reason is Reason.PART_LOST


def test_an_effector_that_opens_before_the_grip_or_in_a_recovery_is_no_failure_of_its_own(rig: Rig) -> None:
    rig.wait_for("sis_a", "main/drive path 0B")
    rig.manual.open_effector("ra_1")
    rig.wait_for("sis_a", "main/move to station 4")
    rig.operate(Verb.CANCEL, "sis_a")
    rig.wait_for("sis_a", "carry back/move to pick-up")
    rig.manual.open_effector("ra_1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert (the_end(rig).state.value, the_end(rig).reason) == ("cancelled", Reason.CANCELLED)
    assert rig.plant.cells["sis_a"].state is CellState.IDLE


def test_a_boot_is_named_as_the_cause(rig: Rig) -> None:
    rig.wait_for("sis_a", "main/move to station 4")
    rig.crash("ra_1")
    rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert the_end(rig).reason in (Reason.REBOOTED, Reason.LINK_LOST)
