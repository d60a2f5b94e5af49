"""A board that assumes itself homed boots unseen: back at zero, its robot moves once a person has looked."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.model.cell_states import CellState
from arboleda.model.messages import MotionState, Reason, Verb
from arboleda.model.plant_model import Evidence

STILL, MOVING = MotionState.STOPPED, MotionState.MOVING
ZERO, HALFWAY = (0.0, 0.0, 0.0), (0.3, 0.1, 0.0)


def at_work(hand: Any, **given: Any) -> Any:
    """A plant whose arm is on its way to the pick-up."""
    plant = hand(Evidence.JOINTS, **({"assume_homed": True} | given))
    plant.awake()
    plant.submit("sis_a palletizing")
    plant.wait(2)
    assert plant.commands(MoveJoints)
    return plant


def obstacle(plant: Any) -> Any:
    return plant.plant.dispatcher.obstacles.of("ra1")


def fall_silent(plant: Any, seconds: float = 3.0) -> None:
    plant.wait(seconds)
    assert obstacle(plant).reason is Reason.LINK_LOST


def back_at_zero(plant: Any) -> None:
    while plant.plant.cells["sis_a"].state is CellState.EXECUTE:
        plant.tell("ra1", after=0.1, state=STILL, q=ZERO)


@pytest.mark.parametrize("last", [HALFWAY, ZERO], ids=["under way", "as it set out"])
def test_after_a_move_it_is_moved_by_nobody_until_a_person_says_where_it_stands(hand: Any, last: Any) -> None:
    plant = at_work(hand)
    plant.tell("ra1", state=MOVING, q=last)
    fall_silent(plant)
    moves = len(plant.commands(MoveJoints))
    back_at_zero(plant)
    assert len(plant.commands(MoveJoints)) == moves
    assert plant.plant.cells["sis_a"].state is CellState.HELD
    assert str(obstacle(plant).sentence) == (
        "ra1 came back at its reference after its link was lost, as a board does that has booted elsewhere"
    )
    first, *_ = plant.plant.advice("sis_a")
    assert (first.do, first.scope, first.by_hand) == (Verb.HOME, "ra1", True)
    plant.operate(Verb.HOME, "ra1", by_hand=True)
    assert obstacle(plant) is None


def test_state_and_joints_that_come_one_after_the_other_say_the_same(hand: Any) -> None:
    plant = at_work(hand)
    plant.tell("ra1", state=MOVING, q=HALFWAY)
    fall_silent(plant)
    plant.tell("ra1", state=STILL)
    plant.tell("ra1", q=ZERO)
    assert obstacle(plant).reason is Reason.NOT_HOMED


def test_one_that_stood_at_its_reference_has_lost_nothing(hand: Any) -> None:
    plant = hand(Evidence.JOINTS, assume_homed=True)
    plant.awake(ra1=ZERO)
    fall_silent(plant)
    plant.tell("ra1", state=STILL, q=ZERO)
    assert obstacle(plant) is None


def test_one_that_a_person_has_put_at_its_reference_has_lost_nothing(hand: Any) -> None:
    plant = at_work(hand)
    plant.tell("ra1", state=MOVING, q=HALFWAY)
    fall_silent(plant)
    back_at_zero(plant)
    plant.operate(Verb.HOME, "ra1", by_hand=True)
    fall_silent(plant)
    plant.tell("ra1", state=STILL, q=ZERO)
    assert obstacle(plant) is None


def test_one_that_is_back_where_it_was_on_its_way_has_not_booted(hand: Any) -> None:
    plant = at_work(hand)
    plant.tell("ra1", state=MOVING, q=HALFWAY)
    fall_silent(plant)
    plant.tell("ra1", state=STILL, q=HALFWAY)
    assert obstacle(plant) is None


def test_one_that_says_itself_if_it_is_homed_is_believed(hand: Any) -> None:
    plant = at_work(hand, assume_homed=False)
    plant.tell("ra1", state=MOVING, q=HALFWAY)
    fall_silent(plant)
    plant.tell("ra1", state=STILL, q=ZERO)
    assert obstacle(plant) is None


def test_one_that_somebody_moved_from_its_reference_is_asked_about_once_it_is_back_there(hand: Any) -> None:
    plant = hand(Evidence.JOINTS, assume_homed=True)
    plant.awake(ra1=ZERO)
    plant.plant.dispatcher.whereabouts.arrive("ra1", ZERO)
    plant.tell("ra1", state=STILL, q=HALFWAY)
    fall_silent(plant)
    plant.tell("ra1", state=STILL, q=ZERO)
    assert obstacle(plant).reason is Reason.NOT_HOMED
