"""Faults that a driver's homing leads out of, and links that are lost for a reason: the advice leads on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from tests.following import follow

from arboleda.model.cell_states import CellState
from arboleda.model.commands import Home
from arboleda.model.messages import MotionState, Reason, Report, TaskState, Verb
from arboleda.model.plant_model import DriverUse, Evidence, PlantModel, Robot
from arboleda.model.sentence import OWN
from arboleda.testing import shipped

from ...plants import made
from ..kinds.lab import Bench, model
from .conftest import Hand
from .test_plant import driven_to_the_arm

WORD = (("health", "protective_stop"),)
WELL = (("health", "ok"),)


def _with_driver(model: PlantModel, *, recovers: bool) -> PlantModel:
    def driven(robot: Robot) -> Robot:
        use = DriverUse(name="own", make=object, facts=("health",), recovers=recovers)
        return replace(robot, driver=use) if robot.name == "ra1" else robot

    return replace(model, cells=tuple(cell.with_robots(driven) for cell in model.cells))


def _in_fault(*, recovers: bool) -> Any:
    """A cell that is held since its arm stopped in the middle of a move."""
    model = _with_driver(shipped(evidence=Evidence.IDS), recovers=recovers)
    plant, move = driven_to_the_arm(lambda evidence: Hand(model), Evidence.IDS)
    plant.tell("ra1", state=MotionState.FAULT, failed=move.id, failure="protective_stop", facts=WORD)
    _beat(plant, state=MotionState.FAULT, facts=WORD)
    assert plant.plant.cells["sis_a"].state is CellState.HELD
    return plant


def _beat(plant: Any, **report: Any) -> None:
    for _ in range(12):
        for robot in plant.plant.model.robots:
            plant.tell(robot, after=0.1, **(report if robot == "ra1" else {}))


def _advised(plant: Any) -> list[str]:
    return [f"{each.do.value} {each.scope}" for each in plant.plant.advice("sis_a")]


def test_the_fault_is_told_by_its_word():
    plant = _in_fault(recovers=False)
    (first, *_) = plant.plant.advice("sis_a")
    assert (first.do.value, str(first.why)) == ("repair", "ra1 is in fault: protective_stop")


def test_homing_is_advised_leads_out_and_the_task_can_be_retried():
    plant = _in_fault(recovers=True)
    assert _advised(plant)[:2] == ["home ra1", "retry sis_a"]
    plant.operate(Verb.HOME, "ra1")
    (home,) = plant.commands(Home)
    plant.tell("ra1", state=MotionState.FAULT, facts=WORD)  # made before it heard of the command
    plant.tell("ra1", state=MotionState.NOT_HOMED, homed=False, accepted=home.id, facts=WORD)
    plant.tell("ra1", state=MotionState.STOPPED, homed=True, done=home.id, facts=WELL)
    _beat(plant, state=MotionState.STOPPED)
    assert _advised(plant) == ["retry sis_a", "abandon sis_a"]


def test_where_homing_failed_a_person_is_sent_to_the_robot():
    plant = _in_fault(recovers=True)
    plant.operate(Verb.HOME, "ra1")
    (home,) = plant.commands(Home)
    plant.tell("ra1", state=MotionState.FAULT, failed=home.id, failure="not yet", facts=WORD)
    _beat(plant, state=MotionState.FAULT, facts=WORD)
    assert _advised(plant)[0] == "repair ra1"


@pytest.mark.parametrize("recovers", [True, False])
def test_homing_a_robot_in_fault_is_refused_unless_its_driver_leads_out(recovers: bool):
    plant = _in_fault(recovers=recovers)
    plant.operate(Verb.HOME, "ra1")
    assert len(plant.commands(Home)) == recovers


WHY = OWN(text="its driver plc has said nothing for 1.5 s")


shut = made("shut", lambda cell: cell.device("oven").close())


def lost(robot: str, at: float) -> Report:
    return Report(at=at, robot=robot, state=MotionState.NO_LINK, lost=WHY)


def test_a_command_that_was_open_fails_with_the_reason_and_the_advice_leads_back() -> None:
    bench = Bench(model(shut))
    bench.submit("bench shut")
    assert bench.wait(20.0, lambda: "oven close" in bench.told)
    bench.tell(lost("oven", bench.now))
    end = bench.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    assert str(end.sentence) == f"oven: the link was lost while doing close: {WHY}"
    follow(bench, "bench")
    bench.submit("bench shut #again")
    assert bench.outcome().state is TaskState.DONE
