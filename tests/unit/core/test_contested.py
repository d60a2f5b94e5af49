"""Several nodes spoke for a robot: once one is left, the robot works again though it says nothing."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.messages import MotionState, Reason, Verb
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import OWN

STILL, MOVING, FAULT = MotionState.STOPPED, MotionState.MOVING, MotionState.FAULT
RIVALS = OWN(text="rm_sis_a: more than one node publishes on /rm_sis_a/motion_state (/other and /robot)")


def contest(plant: Any, robot: str = "rm_sis_a", then: float = 0.6) -> None:
    plant.tell(robot, state=MotionState.NO_LINK, lost=RIVALS)
    plant.wait(then)


def obstacle(plant: Any, robot: str = "rm_sis_a") -> Any:
    return plant.plant.dispatcher.obstacles.of(robot)


@pytest.mark.parametrize("said", [None, STILL], ids=["nothing", "that it stands"])
def test_an_idle_robot_that_speaks_only_when_it_moves_is_ready_again(hand: Any, said: Any) -> None:
    plant = hand(Evidence.STATE)
    if said is not None:
        plant.tell("rm_sis_a", state=said)
    contest(plant)
    assert obstacle(plant).reason is Reason.LINK_LOST
    plant.uncontested("rm_sis_a")
    assert obstacle(plant) is None
    plant.submit("sis_a 0B 7")
    plant.wait(10)
    assert plant.commands(FollowPath)


def test_each_contest_counts_though_its_words_are_those_of_the_last(hand: Any) -> None:
    plant = hand(Evidence.STATE)
    for _ in range(3):
        contest(plant)
        assert obstacle(plant) is not None
        plant.uncontested("rm_sis_a")
        assert obstacle(plant) is None


def test_a_fault_outlasts_a_contest(hand: Any) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=FAULT)
    contest(plant)
    plant.uncontested("rm_sis_a")
    assert obstacle(plant).reason is Reason.DEVICE_FAULT


@pytest.mark.parametrize(
    ("said", "reason"),
    [
        (MotionState.FAULT, Reason.DEVICE_FAULT),
        (MotionState.NOT_HOMED, Reason.NOT_HOMED),
        (MotionState.STOP_LATCHED, Reason.STOPPED),
    ],
)
def test_a_robot_for_which_somebody_said_that_it_cannot_work_has_to_say_itself_that_it_can(
    hand: Any, said: MotionState, reason: Reason
) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=STILL)
    contest(plant)
    plant.uncontested("rm_sis_a", STILL, MOVING, said)
    assert obstacle(plant).reason is reason
    plant.tell("rm_sis_a", state=STILL)
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)  # it may have moved, too
    assert obstacle(plant) is None


def test_a_robot_for_which_somebody_said_that_it_stands_is_ready(hand: Any) -> None:
    plant = hand(Evidence.STATE)
    contest(plant)
    plant.uncontested("rm_sis_a", STILL)
    assert obstacle(plant) is None


def test_a_robot_for_which_somebody_said_that_it_moves_is_moved_by_nobody_until_a_person_says_where_it_is(
    hand: Any,
) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=STILL)
    contest(plant)
    plant.uncontested("rm_sis_a", STILL, MOVING)
    assert obstacle(plant).reason is Reason.NOT_HOMED
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)
    assert obstacle(plant) is None


def test_a_robot_that_was_under_way_is_moved_by_nobody_until_a_person_has_put_it_home(hand: Any) -> None:
    plant = hand(Evidence.STATE)
    plant.submit("sis_a 0B 7")
    plant.wait(2)
    plant.tell("rm_sis_a", state=MOVING)
    contest(plant)
    plant.uncontested("rm_sis_a")
    plant.wait(60)
    assert plant.plant.cells["sis_a"].state is CellState.HELD
    assert obstacle(plant).reason is Reason.NOT_HOMED
    assert len(plant.commands(FollowPath)) == 1
    first, *_ = plant.plant.advice("sis_a")
    assert (first.do, first.scope, first.by_hand) == (Verb.HOME, "rm_sis_a", True)
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)
    assert obstacle(plant) is None


def test_a_robot_that_reports_all_the_time_has_to_be_heard_first(hand: Any) -> None:
    plant = hand(Evidence.JOINTS)
    plant.awake()
    contest(plant, "ra1", then=5.0)
    plant.uncontested("ra1")
    assert obstacle(plant, "ra1").reason is Reason.LINK_LOST
    plant.tell("ra1", q=plant.plant.dispatcher.beliefs["ra1"].q)
    assert obstacle(plant, "ra1") is None


def test_a_robot_that_said_itself_that_it_has_no_link_has_none_after_a_contest(hand: Any) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=STILL)
    plant.tell("rm_sis_a", state=MotionState.NO_LINK)
    contest(plant)
    plant.uncontested("rm_sis_a")
    assert obstacle(plant).reason is Reason.LINK_LOST
    plant.tell("rm_sis_a", state=STILL)
    assert obstacle(plant) is None
