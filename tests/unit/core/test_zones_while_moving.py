"""An arm that was just told to move may be in its zones, whatever it said before."""

from __future__ import annotations

from importlib.resources import as_file, files

import pytest

from arboleda.app.config import load
from arboleda.core.messages import OperatorRequest, Verb
from arboleda.kinds.arm import MoveJoints

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
