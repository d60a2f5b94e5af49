"""What a screen, an operator and a diagnosis are told of a cell."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState, OperatorRequest, Verb
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
    assert plant.plant.cells["sis_a"].queue.paused


def test_a_cell_that_is_being_cleared_waits_for_its_robots_while_they_are_heard(
    hand: Callable[[Evidence], Any],
) -> None:
    def shown() -> tuple[str, bool]:
        cell = view.snapshot(plant.plant)["cells"][0]
        return cell["state"], "wait until its robots have left their stop" in str(cell["waiting_for"])

    plant = hand(Evidence.IDS)
    plant.awake()
    for _ in range(2):
        plant.submit("sis_a palletizing")
    for verb in (Verb.STOP, Verb.CLEAR):
        plant.plant.step(plant.now, [OperatorRequest(at=plant.now, verb=verb, scope="sis_a")])
        for _ in range(3):
            plant.tell("ra1", state=MotionState.STOP_LATCHED, q=(0.0, 0.0, 0.0))
            plant.tell("rm_sis_a", state=MotionState.STOP_LATCHED, node=0)
    assert shown() == ("clearing", True)
    plant.wait(2.0)
    assert shown() == ("stopped", False)


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
