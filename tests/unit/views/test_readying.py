"""What makes a cell, or the whole plant, ready again: the next act, from the view alone."""

from __future__ import annotations

import pytest
from tests.following import works
from tests.readying import due, give, make_ready

from arboleda.model.advice import Hand
from arboleda.model.messages import TaskState, Verb
from arboleda.testing import Rig, shipped, slowed

TASK = "sis_a 0B 7"


@pytest.fixture
def rig() -> Rig:
    rig = Rig(slowed(shipped(), 8))
    rig.wait(0.5)
    return rig


def test_nothing_is_due_where_a_cell_works_or_can_work(rig: Rig) -> None:
    assert due(rig, "sis_a") is None and due(rig) is None
    rig.submit(TASK)
    rig.wait(1.0)
    assert due(rig, "sis_a") is None and due(rig) is None


def test_after_a_stop_a_cell_is_cleared_and_reset_and_its_queue_goes_on(rig: Rig) -> None:
    rig.submit(TASK)
    rig.wait(2.0)
    rig.operate(Verb.STOP, "sis_a")
    acts = make_ready(rig, "sis_a")
    assert acts == ["clear sis_a", "reset sis_a", "resume sis_a"]
    assert works(rig, "sis_a")


def test_the_whole_plant_is_stood_up_before_any_of_it_goes_on(rig: Rig) -> None:
    rig.operate(Verb.STOP)
    rig.submit(TASK)
    stood_up = [f"{verb} {cell}" for verb in ("clear", "reset") for cell in ("sis_a", "sis_b", "sis_c")]
    assert make_ready(rig) == [*stood_up, "resume plant"]
    assert rig.wait(60.0, until=lambda: rig.changes[-1].state is TaskState.DONE)


def test_robots_go_on_once_all_are_ready_and_only_those_that_are_named(rig: Rig) -> None:
    rig.operate(Verb.STOP)
    rig.wait(2.0)
    for verb in (Verb.CLEAR, Verb.RESET):
        rig.operate(verb)
        rig.wait(2.0)
    rig.crash("ra_1")
    rig.wait(5.0)
    assert make_ready(rig) == ["home ra1", "resume plant"]
    rig.operate(Verb.STOP, "sis_a")
    rig.operate(Verb.STOP, "sis_b")
    rig.power_off("ra_1")
    rig.wait(2.0)
    acts = make_ready(rig)
    assert "resume sis_b" in acts and not {"resume sis_a", "resume plant"} & {*acts}


def test_what_is_under_way_is_waited_for(rig: Rig) -> None:
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to station 7")
    rig.crash("ra_1")
    rig.wait(10.0)
    first = due(rig, "sis_a")
    assert first is not None and give(rig, first) == "home ra1"
    rig.wait(0.2)
    found = due(rig, "sis_a")
    assert found is not None and (found.advice, str(found.why)) == (None, "home ra1")


def test_after_a_fault_the_cell_recovers_and_its_queue_goes_on_behind_that(rig: Rig) -> None:
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to pick-up")
    rig.crash("ra_1")
    rig.wait(10.0)
    assert make_ready(rig) == ["home ra1", "retry sis_a", "resume sis_a"]
    assert works(rig, "sis_a")


def test_after_a_restart_the_task_goes_on_where_it_stood(rig: Rig) -> None:
    task = rig.submit(TASK).task
    rig.wait_for("sis_a", "move to station 7")
    rig.crash()
    rig.wait(5.0)
    assert make_ready(rig) == ["resume sis_a"]
    assert rig.wait(60.0, until=lambda: rig.outcomes()[task].state is TaskState.DONE)


def test_no_cell_waits_for_the_task_of_another(rig: Rig) -> None:
    rig.submit(TASK)
    rig.wait_for("sis_a", "move to pick-up")
    rig.crash("ra_1")
    rig.wait(10.0)
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "sis_b")
        rig.wait(2.0)
    acts = make_ready(rig)
    assert acts == ["home ra1", "retry sis_a", "resume sis_b", "resume sis_a"]


def test_while_robots_come_to_rest_one_waits(rig: Rig) -> None:
    rig.submit(TASK)
    rig.wait(3.0)
    rig.operate(Verb.STOP, "sis_a")
    found = due(rig, "sis_a")
    assert found is not None and found.advice is None


def test_work_of_a_hand_ends_it_and_is_named(rig: Rig) -> None:
    rig.power_off("ra_1")
    rig.wait(2.0)
    assert make_ready(rig, "sis_a") == []
    found = due(rig, "sis_a")
    assert found is not None and found.advice is not None
    assert (found.is_act, found.advice["do"]) == (False, Hand.BRING_BACK)
