"""What screens, operators, strangers and a diagnosis are told of a cell."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.core.plant import Plant
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import (
    MotionState,
    OperatorAnswer,
    OperatorRequest,
    TaskChanged,
    TaskRequest,
    Verb,
)
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda.testing.plants import shared
from arboleda.testing.storage_layout import StorageLayout
from arboleda.views import diagnostics, view

from .conftest import Hand


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


def test_an_arm_that_is_seen_at_no_pose_of_a_cell_with_zones_is_to_be_homed() -> None:
    model = shared()
    cell = next(cell for cell in model.cells if StorageLayout(cell).space.zones)
    layout = StorageLayout(cell)
    plant, arm = Hand(model), layout.arm.name
    plant.awake(**{arm: tuple(value + 0.05 for value in layout.home.q)})
    assert [(each.do, each.scope) for each in plant.plant.advice(cell.name)] == [(Verb.HOME, arm)]
    plant.awake()
    assert plant.plant.advice(cell.name) == ()


MODEL = shipped()
ANY = st.text(st.characters(exclude_categories=()), max_size=300)
NEAR = ANY.map(lambda word: f"sis_a {word}")
TASK = ANY.map(lambda word: f"sis_a 0B 7 #{word}")


def plain(text: str) -> bool:
    return text.isprintable() and len(text) <= 2000


@given(text=st.one_of(ANY, NEAR, TASK))
def test_of_a_task(text: str) -> None:
    plant = Plant(MODEL, epoch=1, now=0.0)
    said = [
        each for each in plant.step(0.0, [TaskRequest(at=0.0, text=text)]) if isinstance(each, TaskChanged)
    ]
    assert said and all(plain(each.text) and plain(str(each.sentence)) for each in said)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("verb", Verb)
@given(scope=ANY)
def test_of_an_operators_scope(verb: Verb, scope: str) -> None:
    plant = Plant(MODEL, epoch=1, now=0.0)
    out = plant.step(0.0, [OperatorRequest(at=0.0, verb=verb, scope=scope, by_hand=False)])
    assert all(plain(str(each.refusal or "")) for each in out if isinstance(each, OperatorAnswer))
