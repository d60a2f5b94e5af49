"""An arm that was just told to move may be in its zones, whatever it said before."""

from __future__ import annotations

from importlib.resources import as_file, files

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState, OperatorRequest, Verb
from arboleda.plant_file.loader import load
from arboleda.testing.storage_layout import StorageLayout

from .conftest import Hand


@pytest.fixture
def hand() -> Hand:
    """The plant of shared zones, whose robots stand still at home; arm_right tells joints, and no ids."""
    with as_file(files("arboleda") / "plants" / "shared.yaml") as path:
        hand = Hand(load(path))
    hand.awake()
    return hand


def test_an_arm_that_is_stopped_before_it_says_that_it_moves_keeps_its_zones(hand: Hand) -> None:
    hand.submit("right palletizing")
    while not [each for each in hand.commands(MoveJoints) if each.robot == "arm_right"]:
        hand.wait(0.05)
    assert hand.plant.zones.holder("table") == "arm_right"
    hand.plant.step(hand.now, [OperatorRequest(at=hand.now, verb=Verb.STOP, scope="arm_right")])
    hand.wait(0.05)
    assert hand.plant.zones.holder("table") == "arm_right"


def test_an_arm_whose_move_failed_at_once_may_be_anywhere_until_it_could_have_answered(hand: Hand) -> None:
    hand.submit("right palletizing")
    while not [each for each in hand.commands(MoveJoints) if each.robot == "arm_right"]:
        hand.wait(0.05)
    hand.tell("arm_right", after=0.0, state=MotionState.NO_LINK, epoch=1, plant=7)
    cell = hand.plant.model.cell("right")
    layout = StorageLayout(cell)
    places = []
    for _ in range(3):
        hand.tell("arm_right", after=0.15, state=MotionState.STOPPED, epoch=1, plant=7, q=layout.home.q)
        places.append(hand.plant.dispatcher.whereabouts.place(cell.workspaces["arm_right"]))
    assert places == [None, None, layout.home]
