"""A plant that was away holds what was at work, and nothing moves before somebody says so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import pytest

from arboleda.core import reasons
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Home
from arboleda.model.messages import Absence, OperatorRequest, Reason, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.rig import Rig
from arboleda.rig.world import BRIDGE, PLANT
from arboleda.testing import shipped

from ..lengths import sample

MOTIONS = (MoveJoints, FollowPath, Home)
GAPS_S = (2.0, 20.0, 45.0)
AWAY = ((PLANT,), (PLANT, BRIDGE))
STEPS = ("drive path 0B", "move to pick-up", "effector on/dwell", "move to station 4", "effector off/dwell")
LEVELS = (Evidence.IDS, Evidence.JOINTS)


@pytest.fixture(params=LEVELS, ids=lambda level: level.value)
def rig(request: pytest.FixtureRequest) -> Rig:
    made = Rig(shipped("sis_a", "sis_b", evidence=request.param))
    made.wait(2.0)
    return made


def away(rig: Rig, seconds: float, *processes: str) -> None:
    """These processes do nothing for a while, then what they find is dealt with."""
    for process in processes:
        rig.stall(process, seconds)
    del rig.sent[:]
    rig.wait(seconds + 30.0)


def motions(rig: Rig) -> list[Any]:
    return [message for message in rig.sent if isinstance(message, MOTIONS)]


@pytest.mark.sampled(6)
@pytest.mark.parametrize(
    ("step", "processes", "seconds"),
    sample(product(["drive path 0B", "move to pick-up", "move to station 4"], AWAY, GAPS_S), every=2),
)
def test_a_cell_at_work_is_held_and_its_next_task_waits(
    rig: Rig, seconds: float, processes: tuple[str, ...], step: str
) -> None:
    rig.submit("sis_a 0B 4")
    rig.submit("sis_a 0B 5")
    rig.wait_for("sis_a", f"main/{step}")
    away(rig, seconds, *processes)
    held = rig.plant.cells["sis_a"]
    assert (held.state, held.trouble.reason) == (CellState.HELD, Reason.LINK_LOST)
    assert f"the plant was away for {seconds:.0f}" in str(reasons.of_hold(held))
    assert "retry sis_a or abandon sis_a" in str(reasons.of_hold(held))
    assert motions(rig) == [] and len(held.queue) == 1
    assert [type(each) for each in rig.sent if isinstance(each, Absence)] == [Absence]


def test_retry_gives_the_interrupted_step_anew_and_the_task_is_done(rig: Rig) -> None:
    task = rig.submit("sis_a 0B 4").task
    rig.wait_for("sis_a", "main/move to pick-up")
    away(rig, 20.0, PLANT)
    assert rig.operate(Verb.RETRY, "sis_a") is None
    assert rig.wait(60.0, until=lambda: rig.outcomes()[task].state.value == "done")
    assert rig.plant.intake.tasks[task].attempts == 2


def test_the_time_away_is_no_part_of_a_pause_that_a_step_waits_out() -> None:
    plant = shipped("sis_a")
    rig = Rig(replace(plant, timing=replace(plant.timing, dwell_s=5.0)))
    rig.wait(2.0)
    rig.submit("sis_a 0B 4")
    rig.wait_for("sis_a", "effector on/dwell")
    rig.stall(PLANT, 20.0)
    rig.wait(20.5)
    assert rig.operate(Verb.RETRY, "sis_a") is None
    rig.wait(3.0)
    assert rig.runs("sis_a", "effector on/dwell")
    rig.wait_for("sis_a", "main/move to station 4", 3.0)


def test_abandon_recovers_and_the_queue_waits_for_resume(rig: Rig) -> None:
    first, second = rig.submit("sis_a 0B 4").task, rig.submit("sis_a 0B 5").task
    rig.wait_for("sis_a", "main/move to station 4")
    away(rig, 20.0, PLANT)
    assert rig.operate(Verb.ABANDON, "sis_a") is None
    rig.wait(60.0)
    assert rig.outcomes()[first].reason is Reason.LINK_LOST
    assert rig.outcomes()[second].state.value == "queued"
    assert rig.operate(Verb.RESUME, "sis_a") is None
    assert rig.wait(90.0, until=lambda: rig.outcomes()[second].state.value == "done")


def test_a_recovery_is_held_too_and_goes_on_only_when_told(rig: Rig) -> None:
    rig.submit("sis_a 0B 4")
    rig.wait_for("sis_a", "main/move to station 4")
    assert rig.operate(Verb.CANCEL, "sis_a") is None
    rig.wait(1.0)
    away(rig, 20.0, PLANT)
    assert rig.plant.cells["sis_a"].state is CellState.HELD and motions(rig) == []


def test_a_task_that_waits_in_a_cell_with_nothing_under_way_begins_by_itself(rig: Rig) -> None:
    rig.stop_broker()
    rig.wait(5.0)
    task = rig.submit("sis_a 0B 4").task
    away(rig, 20.0, PLANT)
    cell = rig.plant.cells["sis_a"]
    assert (cell.state, len(cell.queue), cell.queue.paused) == (CellState.IDLE, 1, False)
    rig.start_broker()
    assert rig.wait(120.0, until=lambda: rig.outcomes()[task].state.value == "done")


def test_a_cell_at_work_holds_while_another_one_goes_on(rig: Rig) -> None:
    rig.submit("sis_b 0B 4")
    rig.wait_for("sis_b", "main/drive path 0B")
    away(rig, 20.0, PLANT)
    task = rig.submit("sis_a 0B 4").task
    assert rig.wait(90.0, until=lambda: rig.outcomes()[task].state.value == "done")
    assert rig.plant.cells["sis_b"].state is CellState.HELD


@pytest.mark.sampled(2)
def test_a_cell_with_nothing_to_do_takes_a_task_at_once(rig: Rig) -> None:
    away(rig, 20.0, PLANT)
    task = rig.submit("sis_b 0B 4").task
    assert rig.wait(90.0, until=lambda: rig.outcomes()[task].state.value == "done")


def test_what_is_asked_of_a_plant_that_is_away_is_asked_of_robots_as_it_finds_them(rig: Rig) -> None:
    rig.submit("sis_a 0B 4")
    rig.wait_for("sis_a", "main/move to pick-up")
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(3.0)
    rig.stall(PLANT, 6.0)
    rig.tell(OperatorRequest(at=rig.now, verb=Verb.RESUME, scope="sis_a"))
    rig.power_off("ra_1")
    del rig.sent[:]
    rig.wait(30.0)
    assert motions(rig) == []
    assert rig.plant.cells["sis_a"].state is CellState.HELD


def test_a_short_pause_is_nothing(rig: Rig) -> None:
    task = rig.submit("sis_a 0B 4").task
    rig.wait_for("sis_a", "main/move to pick-up")
    rig.stall(PLANT, 0.7)
    assert rig.wait(90.0, until=lambda: rig.outcomes()[task].state.value == "done")


def test_a_robot_that_was_to_be_homed_at_the_start_waits_for_a_word(
    slowly_booting: Callable[[], Rig],
) -> None:
    rig = slowly_booting()
    away(rig, 20.0, PLANT)
    assert not [each for each in rig.sent if isinstance(each, Home)]
    assert rig.operate(Verb.HOME, "ra1") is None


@pytest.fixture
def slowly_booting() -> Callable[[], Rig]:
    """A plant that homes its arm at the start, as soon as that is heard; it boots while the plant is away."""

    def make() -> Rig:
        made = Rig(shipped("sis_a", evidence=Evidence.IDS, home_at_start=True))
        made.power_off("ra_1")
        made.crash(PLANT)
        made.wait(1.0)
        made.at(made.now + 5.0, lambda _: made.power_on("ra_1"))
        return made

    return make


@pytest.fixture
def going_on() -> Rig:
    """A plant whose first cell goes on by itself after an absence."""
    plant = shipped("sis_a", "sis_b", evidence=Evidence.IDS)
    first, second = plant.cells
    made = Rig(replace(plant, cells=(replace(first, goes_on_after_absence=True), second)))
    made.wait(2.0)
    return made


@pytest.mark.sampled(6)
@pytest.mark.parametrize(("step", "processes", "seconds"), sample(product(STEPS, AWAY, GAPS_S), every=4))
def test_a_cell_goes_on_by_itself_where_the_plant_file_says_so(
    going_on: Rig, seconds: float, processes: tuple[str, ...], step: str
) -> None:
    first, second = (going_on.submit(f"sis_a 0B {station}").task for station in (4, 5))
    going_on.wait_for("sis_a", f"main/{step}" if "/" not in step else step)
    for process in processes:
        going_on.stall(process, seconds)
    going_on.wait(seconds + 90.0)
    assert [going_on.outcomes()[task].state.value for task in (first, second)] == ["done", "done"]


def test_a_cell_whose_arm_lost_its_supply_meanwhile_stays_held(going_on: Rig) -> None:
    going_on.submit("sis_a 0B 4")
    going_on.wait_for("sis_a", "main/move to station 4")
    going_on.stall(PLANT, 3.0)
    going_on.power_off("ra_1")
    going_on.wait(4.0)
    going_on.power_on("ra_1")
    del going_on.sent[:]
    going_on.wait(60.0)
    assert going_on.plant.cells["sis_a"].state is CellState.HELD and motions(going_on) == []


def test_who_is_heard_again_long_after_an_absence_moves_nothing(going_on: Rig) -> None:
    going_on.submit("sis_a 0B 4")
    going_on.wait_for("sis_a", "main/move to pick-up")
    going_on.stop_broker()
    going_on.stall(PLANT, 3.0)
    going_on.wait(60.0)
    del going_on.sent[:]
    going_on.start_broker()
    going_on.wait(60.0)
    assert going_on.plant.cells["sis_a"].state is CellState.HELD and motions(going_on) == []


def test_a_cell_of_which_the_file_says_nothing_stays_held_beside_one_that_goes_on(going_on: Rig) -> None:
    first, second = going_on.submit("sis_a 0B 4").task, going_on.submit("sis_b 0B 4").task
    going_on.wait_for("sis_b", "main/drive path 0B")
    going_on.stall(PLANT, 3.0)
    assert going_on.wait(120.0, until=lambda: going_on.outcomes()[first].state.value == "done")
    assert going_on.plant.cells["sis_b"].state is CellState.HELD
    assert going_on.outcomes()[second].state.value == "running"


def test_a_queue_that_was_paused_before_an_absence_stays_so(going_on: Rig) -> None:
    first = going_on.submit("sis_a 0B 4").task
    going_on.wait_for("sis_a", "main/move to pick-up")
    going_on.plant.cells["sis_a"].queue.paused = True
    going_on.stall(PLANT, 3.0)
    assert going_on.wait(120.0, until=lambda: going_on.outcomes()[first].state.value == "done")
    assert going_on.plant.cells["sis_a"].queue.paused


def test_a_hold_of_an_operator_is_still_his(rig: Rig) -> None:
    rig.submit("sis_a 0B 4")
    rig.wait_for("sis_a", "main/move to pick-up")
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(5.0)
    away(rig, 1.8, PLANT)
    assert rig.plant.cells["sis_a"].state is CellState.HELD and motions(rig) == []
