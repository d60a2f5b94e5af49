"""A reported opening of an effector that carries counts at every evidence level."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState, Reason
from arboleda.model.plant_model import Evidence

MOVING, STILL = MotionState.MOVING, MotionState.STOPPED


@pytest.mark.parametrize("level", list(Evidence), ids=lambda level: level.value)
def test_whatever_the_evidence_a_reported_opening_counts(
    hand: Callable[[Evidence], Any], level: Evidence
) -> None:
    plant = hand(level)
    plant.awake()
    plant.submit("sis_a palletizing")
    carries(plant, level)
    plant.tell("ra1", state=MOVING, effector=True)
    plant.tell("ra1", state=MOVING, effector=False)
    assert plant.plant.cells["sis_a"].context.failures.first.reason is Reason.PART_LOST


def carries(plant: Any, level: Evidence) -> None:
    """Play the arm until it is on its way with the part."""
    for _ in range(60):
        entry = plant.plant.dispatcher.ledger.last_sent.get("ra1")
        command = entry.command if entry else None
        closed = bool(plant.commands(SetEffector))
        if closed and isinstance(command, MoveJoints):
            return
        ids = {"accepted": command.id, "done": command.id} if level is Evidence.IDS and command else {}
        where = {"q": command.q} if isinstance(command, MoveJoints) and level is not Evidence.STATE else {}
        plant.tell("ra1", after=1.2, state=MOVING, effector=closed)
        for _ in range(3):
            plant.tell("ra1", after=0.3, state=STILL, effector=closed, **where, **ids)
    raise AssertionError("it never carried anything")
