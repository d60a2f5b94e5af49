"""A task is done only with its part, where the arm's board says whether it has one; else it says so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import cast

import pytest

from arboleda.model.messages import Check, Reason, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.recipes import Kit, recipe, work
from arboleda.rig import faults
from arboleda.sim.arm import ArmBody
from arboleda.testing import Rig, shipped, slowed

CELL = "sis_a"
TASKS = {"storage": "sis_a 0B 7 #one", "palletizing": "ra1 palletizing #one"}
tasks = pytest.mark.parametrize("recipe_name", TASKS)


def body(rig: Rig) -> ArmBody:
    return cast(ArmBody, rig.devices.boards["ra_1"].body)


def shipped_rig() -> Rig:
    """The shipped cell as it comes."""
    rig = Rig(slowed(shipped(CELL), 2))
    rig.wait(0.5)
    return rig


def mute(rig: Rig) -> None:
    """The board has no piece sensor."""
    rig.carry = faults.says("ra_1", pieza=None)


def ended(rig: Rig) -> TaskChanged:
    assert rig.wait(120.0, until=lambda: rig.plant.cells[CELL].task is None), "it hangs"
    return rig.outcomes()["one"]


def no_part(rig: Rig) -> None:
    body(rig).supplied = False


def no_grip(rig: Rig) -> None:
    body(rig).grips = False


def lost_part(rig: Rig) -> None:
    assert rig.wait(60.0, until=lambda: body(rig).holding and body(rig).moving)
    rig.wait(0.2)
    body(rig).lose_piece()


def lost_as_it_arrives(rig: Rig) -> None:
    """Later than a look on the way would notice, and before the board says that the arm stands there."""
    assert rig.wait(60.0, until=lambda: body(rig).holding and body(rig).moving)
    assert rig.wait(60.0, until=lambda: (body(rig).next_change_us or 0) < round(rig.now * 1e6) + 50_000)
    body(rig).lose_piece()


WITHOUT: dict[Callable[[Rig], None], Reason] = {
    no_part: Reason.NO_PIECE,
    no_grip: Reason.PART_LOST,
    lost_part: Reason.PART_LOST,
    lost_as_it_arrives: Reason.PART_LOST,
}


@tasks
@pytest.mark.parametrize("happens", WITHOUT, ids=lambda each: each.__name__)
def test_a_task_of_the_shipped_plant_without_its_part_fails(
    happens: Callable[[Rig], None], recipe_name: str
) -> None:
    rig = shipped_rig()
    rig.submit(TASKS[recipe_name])
    happens(rig)
    change = ended(rig)
    assert (change.state, change.reason, change.unchecked) == (TaskState.FAILED, WITHOUT[happens], ())
    assert not any(rig.plant.cells[CELL].context.places.counts.values())


@tasks
def test_a_task_of_the_shipped_plant_with_its_part_is_done_and_all_is_checked(recipe_name: str) -> None:
    rig = shipped_rig()
    rig.submit(TASKS[recipe_name])
    change = ended(rig)
    assert (change.state, change.unchecked, str(change.sentence)) == (TaskState.DONE, (), "")


@tasks
def test_without_a_piece_sensor_the_task_is_done_and_says_what_nobody_checked(recipe_name: str) -> None:
    rig = shipped_rig()
    mute(rig)
    rig.crash("ra_1")  # a word of an earlier boot is no sensor
    rig.wait(2.0)
    rig.operate(Verb.HOME, "ra1")
    rig.wait(30.0)
    rig.submit(TASKS[recipe_name])
    change = ended(rig)
    assert (change.state, change.unchecked) == (TaskState.DONE, (Check.GRIP,))
    assert str(change.sentence) == "not checked: whether the part was gripped"


def test_a_sensor_that_falls_silent_within_a_boot_is_waited_for() -> None:
    rig = shipped_rig()
    mute(rig)
    rig.submit(TASKS["storage"])
    assert ended(rig).reason is Reason.NO_PIECE


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE])
def test_who_says_nothing_of_its_effector_has_released_nothing_for_sure(evidence: Evidence) -> None:
    rig = Rig(slowed(shipped(CELL, evidence=evidence), 2))
    rig.wait(0.5)
    rig.submit(TASKS["storage"])
    change = ended(rig)
    assert (change.state, change.unchecked) == (TaskState.DONE, (Check.GRIP, Check.RELEASE))
    assert str(change.sentence) == "not checked: whether the part was gripped and let go of"


@recipe("fetch")
def fetch(cell: Kit):  # type: ignore[no-untyped-def]
    arm = cell.device("arm")
    return work(arm.visit("pickup", arm.grip()), arm.visit("station_7", arm.let_go()), arm.home())


def test_a_recipe_of_ones_own_asks_no_piece_sensor_and_says_so() -> None:
    model = shipped(CELL)
    rig = Rig(replace(model, cells=tuple(replace(each, recipes=(fetch,)) for each in model.cells)))
    rig.wait(0.5)
    rig.submit("sis_a fetch #one")
    change = ended(rig)
    assert (change.state, change.unchecked) == (TaskState.DONE, (Check.GRIP,))
