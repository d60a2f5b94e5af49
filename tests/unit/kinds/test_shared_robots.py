"""An arm and its gripper that two cells share: handed on empty and at home, whatever befalls who has them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.following import advised, follow

from arboleda.core.plant import Plant
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.model.plant_model import Cell, Interlock, PlantModel, Pose, Workspace
from arboleda.model.recipe import Recipe
from arboleda.model.whole_cells import whole_cell
from arboleda.recipes import Kit, recipe, work
from arboleda.views import view

from ...plants import device_of
from .lab import Bench
from .tending import FEED, GRIPPER, HOME, LAMP, VISE, arm
from .test_shared_devices import ended, state_of


@recipe("carry")
def carry(cell: Kit):  # type: ignore[no-untyped-def]
    """From the feed into the vise, which lies in a zone."""
    robot, jaw, lamp = cell.devices("robot", "jaw", "lamp")
    return work(
        lamp.light(on=True),
        robot.visit("feed", jaw.close()),
        robot.visit("vise", jaw.open()),
        robot.go("feed"),  # and there it would stay
        lamp.light(on=False),
    )


@recipe("keep")
def keep(cell: Kit):  # type: ignore[no-untyped-def]
    """Takes a part, and forgets it."""
    robot, jaw, lamp = cell.devices("robot", "jaw", "lamp")
    return work(robot.visit("feed", jaw.close()), lamp.light(on=True))


def plant(*recipes: Recipe) -> PlantModel:
    """`left` and `right`, each with a lamp of its own; both have the arm and its jaw."""
    robot, jaw = arm("robot"), device_of(GRIPPER, "jaw")
    cells = []
    for name, sign in (("left", 1.0), ("right", -1.0)):
        lamp = device_of(LAMP, f"{name}_lamp")
        home = Pose(name="home", q=HOME)
        feed = Pose(name="feed", q=(sign * FEED[0], FEED[1]), above=(sign * FEED[0], 0.0))
        vise = Pose(name="vise", q=(sign * VISE[0], -VISE[1]), zones=frozenset({"vise"}))
        space = Workspace(robot=robot, tool=jaw, home=home, poses=(home, feed, vise))
        members = (("lamp", lamp), ("robot", robot), ("jaw", jaw))
        cell = Cell(name=name, queue_limit=5, members=members, spaces=(space,), shared=("robot", "jaw"))
        cells.append(replace(cell, recipes=recipes or (carry, keep)))
    return PlantModel(name="shop", cells=tuple(cells), zones=("vise",))


def holder(here: Bench, device: str = "robot") -> str | None:
    return here.plant.zones.holder(device)


def at_home(here: Bench) -> bool:
    belief = here.plant.dispatcher.beliefs["robot"]
    return belief.q is not None and all(abs(value) < 0.01 for value in belief.q)


def carrying(model: PlantModel | None = None, text: str = "left carry") -> Bench:
    """The cell on the left has the arm, and a part in its jaw."""
    here = Bench(model or plant())
    here.submit(text)
    assert here.wait(20.0, lambda: here.plant.dispatcher.effectors.grips["jaw"].value == "on")
    here.wait(0.4)
    assert holder(here) == holder(here, "jaw") == "left"
    return here


def restarted(here: Bench) -> Bench:
    """The same boards and memory with a plant that has no task of before."""
    here.plant = Plant(here.model, epoch=here.plant.epoch + 1, now=here.now, memory=here.disk.facts)
    return here


def test_two_cells_use_it_one_after_the_other_and_each_leaves_it_at_home() -> None:
    here = Bench(plant())
    here.submit("left carry")
    here.submit("right carry")
    last, handed_on = None, []
    while not ended(here, "left", "right")():
        here.wait(0.05)
        if holder(here) != last:
            last = holder(here)
            handed_on.append((last, at_home(here)))
    assert {state_of(here, "left"), state_of(here, "right")} == {TaskState.DONE}
    assert handed_on == [("left", True), ("right", True), (None, True)]
    assert holder(here, "jaw") is None


def test_it_is_not_given_back_with_a_part_in_it_and_a_recovery_takes_that_back() -> None:
    here = Bench(plant())
    here.submit("left keep")
    here.submit("right carry")
    assert here.wait(60.0, ended(here, "left"))
    change = next(each for each in reversed(here.changes) if each.cell == "left")
    assert change.reason is Reason.PRECONDITION
    assert "jaw may still hold a part after its last step" in str(change.sentence)
    assert here.plant.dispatcher.effectors.grips["jaw"].value == "off"
    assert here.wait(60.0, ended(here, "right"))
    assert state_of(here, "right") is TaskState.DONE


def test_a_cell_that_is_held_keeps_it_with_its_part() -> None:
    here = carrying()
    here.operate(Verb.HOLD, "left")
    here.submit("right carry")
    here.wait(20.0)
    assert holder(here) == "left"
    assert here.plant.cells["right"].state is CellState.EXECUTE
    assert here.plant.cells["right"].context.parts.holding == []
    assert here.plant.cells["left"].context.parts.holding == ["jaw"]
    assert here.operate(Verb.RESUME, "left") is None
    assert here.wait(60.0, ended(here, "left"))
    assert state_of(here, "left") is TaskState.DONE


def test_a_cancelled_task_brings_the_part_back_and_the_arm_home_before_another_cell_has_it() -> None:
    here = carrying()
    here.operate(Verb.CANCEL, "left")
    here.submit("right carry")
    assert here.wait(60.0, lambda: holder(here) == "right")
    assert at_home(here)
    assert here.wait(60.0, ended(here, "left", "right"))
    assert state_of(here, "left") is TaskState.CANCELLED
    assert state_of(here, "right") is TaskState.DONE


@pytest.mark.sampled(4)
@pytest.mark.parametrize("stopped", ["left", "right", "robot", "plant"])
def test_after_a_stop_it_stays_with_its_cell_and_the_advice_leads_everybody_back(stopped: str) -> None:
    here = carrying()
    here.operate(Verb.STOP, stopped)
    here.wait(8.0)
    assert not here.boards["robot"].body.moving
    assert holder(here) == "left"
    assert here.plant.dispatcher.effectors.grips["jaw"].value == "on"
    for _ in range(3):
        for cell in ("right", "left"):
            if advised(here, cell):
                follow(here, cell)
                here.wait(8.0)
    for cell in ("left", "right"):
        here.submit(f"{cell} carry")
        assert here.wait(90.0, ended(here, cell))
        assert state_of(here, cell) is TaskState.DONE, cell
    assert holder(here) is None


def test_a_restart_with_a_part_in_it_gives_it_to_the_cell_that_had_it() -> None:
    here = restarted(carrying())
    here.wait(5.0)
    assert holder(here) == holder(here, "jaw") == "left"
    assert here.plant.cells["left"].state is CellState.HELD
    assert "jaw may hold a part" in str(here.plant.cells["left"].trouble.sentence)  # type: ignore[union-attr]
    assert here.plant.cells["right"].state is CellState.IDLE
    assert here.plant.cells["right"].not_ready is None
    assert here.operate(Verb.RELEASE, "jaw") is None
    here.wait(3.0)
    assert holder(here) == "left"
    sentence = "robot, which cells share, is not seen at its home; home robot mends that"
    assert str(here.plant.cells["left"].not_ready) == sentence
    assert advised(here, "left")[0] == "home robot"
    assert here.operate(Verb.HOME, "robot") is None
    assert here.wait(30.0, lambda: holder(here) is None)
    assert at_home(here)


def test_what_no_cell_has_and_is_not_at_home_is_taken_by_none_before_it_is_homed() -> None:
    here = carrying()
    here.disk.facts.clear()  # as with another store
    restarted(here)
    here.wait(5.0)
    right = str(here.plant.cells["right"].not_ready)
    assert right == "robot, which cells share, is not seen at its home; home robot mends that"
    assert here.plant.cells["left"].context.parts.holding == ["jaw"]  # its first cell answers for it


def test_homing_is_for_the_cell_that_has_it_and_keeps_others_off_meanwhile() -> None:
    here = Bench(plant())
    here.wait(2.0)
    assert here.operate(Verb.HOME, "robot") is None
    assert holder(here) == holder(here, "jaw") == "left"
    assert here.wait(30.0, lambda: holder(here) is None)
    here = carrying(text="left carry")
    assert "left is in execute; this needs a cell that is idle or held" in str(
        here.operate(Verb.HOME, "robot")
    )
    refusal = "robot, which cells share, is with left now"
    assert str(here.operate(Verb.HOME, "right")) == refusal


def without_zones_on_the_left() -> PlantModel:
    """The plant with a vise on the right alone, which lies in a zone; a lamp that is out keeps that."""
    model = plant()
    left, right = model.cells
    (space,) = left.spaces
    poses = tuple(pose for pose in space.poses if pose.name != "vise")
    lock = Interlock(device="right_lamp", zone="vise", free_while=(("lit", True),))
    left = replace(left, spaces=(replace(space, poses=poses),))
    return replace(model, cells=(left, replace(right, interlocks=(lock,))))


def test_homing_for_a_cell_without_zones_ends_outside_those_of_the_other_one() -> None:
    model = without_zones_on_the_left()
    left, right = model.cells
    here = Bench(replace(model, cells=(left, replace(right, interlocks=()))))
    here.wait(2.0)
    assert here.operate(Verb.HOME, "robot") is None
    assert holder(here) == "left" and here.plant.zones.holder("vise") == "robot"
    assert here.wait(30.0, lambda: holder(here) is None)
    assert here.plant.zones.holder("vise") is None
    assert here.plant.cells["left"].not_ready is None


def test_the_advice_for_a_cell_without_zones_names_the_machine_of_the_other_one_in_the_way() -> None:
    here = Bench(without_zones_on_the_left())
    here.wait(2.0)
    here.power_off("robot")
    here.wait(3.0)
    here.power_on("robot")
    here.wait(3.0)
    ways = ["do right_lamp light true", "home robot"]
    assert advised(here, "left") == advised(here, "right") == ways


def test_release_is_for_the_cell_that_has_it() -> None:
    here = carrying()
    here.operate(Verb.HOLD, "left")
    here.wait(2.0)
    assert str(here.operate(Verb.RELEASE, "right")) == "jaw, which cells share, is with left now"
    assert here.operate(Verb.RELEASE, "jaw") is None
    here.wait(3.0)
    assert here.plant.dispatcher.effectors.grips["jaw"].value == "off"
    assert here.plant.cells["left"].stranded


def test_an_override_does_not_make_it_anybodys_who_does_not_know_where_it_is() -> None:
    here = carrying()
    here.power_off("robot")
    here.wait(3.0)
    here.operate(Verb.STOP, "left")
    here.wait(8.0)
    assert here.plant.zones.is_quarantined("robot")
    refusal = str(here.operate(Verb.OVERRIDE, "robot"))
    assert refusal.startswith("robot stays with left until it is heard, holds no part and is at home")
    assert holder(here) == "left"


def test_its_places_in_all_cells_are_those_of_its_board_and_of_drawings() -> None:
    model = plant()
    (space,) = whole_cell(model, "robot").spaces
    assert [pose.name for pose in space.poses] == ["home", "feed", "vise", "right feed", "right vise"]
    snapshot = view.snapshot(Bench(model).plant)
    assert [row["name"] for row in snapshot["robots"]].count("robot") == 1
