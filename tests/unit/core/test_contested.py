"""Several nodes spoke for a robot: once one is left, the robot works again though it says nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.kinds.mobile import FollowPath
from arboleda.model.advice import in_words
from arboleda.model.cell_states import CellState
from arboleda.model.messages import MotionState, Reason, Verb
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import OWN
from arboleda.plant_file import loader

from .conftest import Hand

STILL, MOVING, FAULT = MotionState.STOPPED, MotionState.MOVING, MotionState.FAULT
NOT_HOMED, LATCHED = MotionState.NOT_HOMED, MotionState.STOP_LATCHED
PRESS = """name: shop
kinds:
  press:
    facts: {pressed: bool}
    verbs:
      press: {effect: %s, sets: {pressed: true}}
cells:
  left:
    devices:
      press: {kind: press, name: press_1, link: ros, evidence: state}
"""
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


def advised(plant: Any, cell: str = "sis_a") -> list[str]:
    return [str(in_words(each)) for each in plant.plant.advice(cell)]


@pytest.mark.parametrize("said", [FAULT, NOT_HOMED])
def test_what_only_others_may_have_said_ends_on_the_word_of_a_person_at_the_robot(
    hand: Any, said: MotionState
) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=STILL)
    contest(plant)
    plant.uncontested("rm_sis_a", said)
    assert advised(plant) == ["home rm_sis_a --by-hand"]
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)
    assert (obstacle(plant), advised(plant)) == (None, [])
    plant.submit("sis_a 0B 7")
    plant.wait(10)
    assert plant.commands(FollowPath)


@pytest.mark.parametrize(
    ("own", "way_out"), [(FAULT, "repair rm_sis_a"), (NOT_HOMED, "home rm_sis_a at its own controls")]
)
def test_what_the_robot_itself_has_said_it_has_to_take_back_itself(
    hand: Any, own: MotionState, way_out: str
) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=own)
    contest(plant)
    plant.uncontested("rm_sis_a", FAULT)
    assert advised(plant) == [way_out]
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)
    assert obstacle(plant).reason is Reason.DEVICE_FAULT


def test_what_others_may_have_said_is_not_taken_for_the_robots_own_word_in_the_next_contest(
    hand: Any,
) -> None:
    plant = hand(Evidence.STATE)
    contest(plant)
    plant.uncontested("rm_sis_a", FAULT)
    contest(plant)
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)  # while nobody is believed, it may be said once more
    plant.uncontested("rm_sis_a", STILL)
    assert advised(plant) == ["home rm_sis_a --by-hand"]
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)
    assert obstacle(plant) is None


def test_what_the_robot_said_before_is_in_force_again_once_a_person_has_denied_what_others_said(
    hand: Any,
) -> None:
    plant = hand(Evidence.STATE)
    plant.tell("rm_sis_a", state=LATCHED)
    contest(plant)
    plant.uncontested("rm_sis_a", FAULT)
    plant.operate(Verb.HOME, "rm_sis_a", by_hand=True)
    assert obstacle(plant).reason is Reason.STOPPED


@pytest.mark.parametrize("said", [(), (FAULT,), (MOVING,)])
def test_a_stopped_robot_that_says_its_stop_once_is_cleared_after_a_contest(hand: Any, said: Any) -> None:
    plant = hand(Evidence.STATE)
    plant.operate(Verb.STOP, "sis_a")
    for robot in ("ra1", "rm_sis_a"):
        plant.tell(robot, state=LATCHED)
    contest(plant)
    plant.uncontested("rm_sis_a", *said)
    plant.operate(Verb.CLEAR, "sis_a")
    for robot in ("ra1", "rm_sis_a"):
        plant.tell(robot, state=STILL)
    plant.operate(Verb.RESET, "sis_a")
    assert plant.plant.cells["sis_a"].state is CellState.IDLE


@pytest.mark.parametrize("effect", ["process", "switch"])
@pytest.mark.parametrize("said", [FAULT, NOT_HOMED])
def test_a_device_without_homing_of_which_others_may_have_said_it_is_led_out_by_a_stop(
    tmp_path: Path, effect: str, said: MotionState
) -> None:
    (tmp_path / "plant.yaml").write_text(PRESS % effect)
    plant = Hand(loader.load(tmp_path / "plant.yaml", recipes=False))
    plant.tell("press_1", state=STILL)
    contest(plant, "press_1")
    plant.uncontested("press_1", said)
    assert obstacle(plant, "press_1") is not None
    assert advised(plant, "left") == ["stop left", "clear left", "reset left"]
    for verb, state in ((Verb.STOP, LATCHED), (Verb.CLEAR, STILL), (Verb.RESET, STILL)):
        plant.operate(verb, "left")
        if effect == "process":  # only a device that works has to say that it stands
            plant.tell("press_1", state=state)
        plant.wait(1)
    assert obstacle(plant, "press_1") is None
    assert plant.plant.cells["left"].state is CellState.IDLE


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
