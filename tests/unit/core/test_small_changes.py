"""What a screen, an operator and a diagnosis are told of a cell."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.kinds.arm import MoveJoints
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.model.plant_model import Evidence
from arboleda.views import diagnostics, view


def test_a_screen_is_told_that_a_step_is_over(hand: Callable[[Evidence], Any]) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.submit("sis_a palletizing")
    before = plant.plant.version
    plant.wait(plant.plant.model.timing.dwell_s)
    assert plant.commands(MoveJoints)
    assert plant.plant.version != before


def test_a_hold_pauses_the_queue(hand: Callable[[Evidence], Any]) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.submit("sis_a palletizing")
    plant.plant.step(plant.now, [OperatorRequest(at=plant.now, verb=Verb.HOLD, scope="sis_a")])
    assert plant.plant.cells["sis_a"].queue_paused


def test_a_cell_is_diagnosed_with_its_state_its_queue_and_its_step(hand: Callable[[Evidence], Any]) -> None:
    plant = hand(Evidence.IDS)
    plant.awake()
    plant.submit("sis_a palletizing")
    plant.submit("sis_a palletizing")
    rows = {name: values for name, _, _, _, values in diagnostics.diagnostics(view.snapshot(plant.plant))}
    shown = {"state": "execute", "queued": "1", "step": "system start"}
    assert rows["arboleda: sis_a"] == {**shown, "waiting_for": "sis_a is busy", "advice": ""}
    assert rows["arboleda: sis_b"] == {
        "state": "idle",
        "queued": "0",
        "step": "",
        "waiting_for": "",
        "advice": "",
    }
