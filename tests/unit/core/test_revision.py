"""Another version of a plant that runs: who takes what of it when, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.core import reasons
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import (
    CellRevised,
    RestartRequest,
    Revision,
    RevisionAnswer,
    RevisionName,
    TaskChanged,
    TaskState,
    Verb,
)
from arboleda.model.plant_model import Cell, PlantModel, Pose, Retry, Timing
from arboleda.model.recipe import Recipe
from arboleda.rig.rig import Rig
from arboleda.testing import shipped

NEXT = RevisionName(digest="d1", number=2)
Q = (0.1, 0.2, 0.05)
WORK = "sis_a palletizing"


def with_cell(plant: PlantModel, cell: str = "sis_a", **fields: Any) -> PlantModel:
    cells = [replace(each, **fields) if each.name == cell else each for each in plant.cells]
    return replace(plant, cells=tuple(cells))


def moved(plant: PlantModel, cell: str = "sis_a", q: tuple[float, ...] = Q) -> PlantModel:
    """The plant with the first place of a rack elsewhere."""
    found = plant.cell(cell)
    name = found.stations[0].name

    def there(pose: Pose) -> Pose:
        return replace(pose, q=q, above=None) if pose.name == name else pose

    spaces = [replace(space, poses=tuple(map(there, space.poses))) for space in found.spaces]
    return with_cell(plant, cell, spaces=tuple(spaces))


def goals(rig: Rig, robot: str = "ra1") -> list[object]:
    return [each.way[-1] for each in rig.sent if isinstance(each, MoveJoints) and each.robot == robot]


def put(rig: Rig, model: PlantModel, version: RevisionName = NEXT) -> RevisionAnswer:
    rig.plant.versions[version.digest] = model
    rig.tell(Revision(at=rig.now, version=version, by="Ana", changes=("one",)))
    return [each for each in rig.sent if isinstance(each, RevisionAnswer)][-1]


def taken(rig: Rig) -> list[str]:
    return [each.cell for each in rig.sent if isinstance(each, CellRevised)]


def store(rig: Rig, text: str) -> TaskChanged:
    rig.submit(text)
    assert rig.wait(200.0, until=lambda: rig.outcomes()[text].state is not TaskState.RUNNING)
    return rig.outcomes()[text]


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped("sis_a", "sis_b"))
    rig.wait(2.0)
    return rig


def ended(rig: Rig, task: str) -> bool:
    return rig.plant.intake.tasks[task].ended_at is not None


def test_a_cell_at_rest_takes_a_version_at_once(rig: Rig) -> None:
    answer = put(rig, moved(rig.model))
    assert (answer.refusal, answer.waits, answer.cancelled) == (None, (), ())
    assert taken(rig) == ["sis_a", "sis_b"]
    assert rig.plant.model.cell("sis_a") is rig.plant.cells["sis_a"].cell
    assert rig.plant.model.cell("sis_a").stations[0].q == Q
    task = rig.submit("sis_a 0B 0").task
    assert rig.wait(200.0, until=lambda: ended(rig, task))
    assert rig.plant.intake.tasks[task].state is TaskState.DONE and Q in goals(rig)


def test_what_is_under_way_ends_with_its_own_and_what_waits_begins_with_the_new_one(rig: Rig) -> None:
    before = rig.model.cell("sis_a").stations[0].q
    first, second = (rig.submit("sis_a 0B 0").task for _ in range(2))
    rig.wait(1.0)
    answer = put(rig, moved(rig.model))
    assert answer.waits == (("sis_a", first),) and taken(rig) == ["sis_b"]
    assert rig.wait(200.0, until=lambda: ended(rig, first))
    assert before in goals(rig) and Q not in goals(rig)
    assert taken(rig) == ["sis_b", "sis_a"]
    rig.operate(Verb.RESUME, "sis_a")
    assert rig.wait(200.0, until=lambda: ended(rig, second))
    assert Q in goals(rig)


def test_a_held_task_goes_on_with_its_own(rig: Rig) -> None:
    task = rig.submit("sis_a 0B 0").task
    rig.wait(1.0)
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(3.0)
    assert put(rig, moved(rig.model)).waits == (("sis_a", task),)
    assert rig.operate(Verb.RESUME, "sis_a") is None
    assert rig.wait(200.0, until=lambda: ended(rig, task))
    assert Q not in goals(rig) and taken(rig)[-1] == "sis_a"


def test_a_stopped_cell_takes_it_and_moves_nothing(rig: Rig) -> None:
    rig.submit("sis_a 0B 0")
    rig.wait(1.0)
    rig.operate(Verb.STOP, "sis_a")
    rig.wait(3.0)
    sent = len(goals(rig))
    assert put(rig, moved(rig.model)).waits == () and "sis_a" in taken(rig)
    rig.wait(3.0)
    assert len(goals(rig)) == sent


def without(cell: Cell, recipe: str) -> tuple[Recipe, ...]:
    return tuple(each for each in cell.recipes if each.name != recipe)


def test_a_task_that_waits_for_a_recipe_that_is_gone_is_told_so(rig: Rig) -> None:
    first = rig.submit("sis_a 0B 0").task
    unfit, fit = rig.submit(WORK).task, rig.submit("sis_a 0B 1").task
    rig.wait(1.0)
    answer = put(rig, with_cell(rig.model, recipes=without(rig.model.cell("sis_a"), "palletizing")))
    assert answer.cancelled == (unfit,)
    told = rig.plant.intake.tasks[unfit]
    assert told.state is TaskState.CANCELLED and told.failure is not None
    assert "does not take it" in str(told.failure.sentence)
    assert not ended(rig, first) and not ended(rig, fit)
    assert rig.submit(WORK).state is TaskState.REFUSED  # already while the cell works by what was before


def test_a_text_that_would_mean_other_work_is_not_done(rig: Rig) -> None:
    recipes = rig.model.cell("sis_a").recipes
    rig.operate(Verb.HOLD, "sis_b")
    rig.submit("sis_a 0B 0")
    waits = rig.submit("sis_a 0B 1").task
    rig.wait(1.0)
    other = tuple(replace(each, name="other" if each.is_default else each.name) for each in recipes)
    assert put(rig, with_cell(rig.model, recipes=other)).cancelled == (waits,)
    assert "other work" in str(rig.plant.intake.tasks[waits].failure)


def test_times_count_for_a_cell_once_it_has_taken_them(rig: Rig) -> None:
    task = rig.submit("sis_a 0B 0").task
    rig.wait(1.0)
    put(rig, replace(rig.model, timing=replace(rig.model.timing, dwell_s=1.5)))
    timing = {name: run.context.timing for name, run in rig.plant.cells.items()}
    assert (timing["sis_a"], timing["sis_b"].dwell_s) == (Timing(dwell_s=rig.model.timing.dwell_s), 1.5)
    assert rig.wait(200.0, until=lambda: ended(rig, task))
    assert rig.plant.cells["sis_a"].context.timing.dwell_s == 1.5


def test_a_limit_of_a_queue_and_retries_change(rig: Rig) -> None:
    put(rig, with_cell(rig.model, queue_limit=1, retry=Retry(times=3)))
    assert rig.plant.cells["sis_a"].context.cell.retry.times == 3
    rig.operate(Verb.HOLD, "sis_a")
    answers = [rig.submit("sis_a 0B 0").state for _ in range(3)]
    assert answers[-1] is TaskState.REFUSED


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        (lambda plant: replace(plant, cells=plant.cells[:1]), "cells are others"),
        (lambda plant: with_cell(plant, members=plant.cell("sis_a").members[:1]), "devices of sis_a"),
        (lambda plant: replace(plant, timing=replace(plant.timing, stale_after_s=9.0)), "longest silence"),
        (lambda plant: replace(plant, name="other"), "its name"),
        (lambda plant: with_cell(plant, arrays=()), "places, needs or interlocks of sis_a"),
    ],
)
def test_what_a_plant_that_runs_cannot_take_changes_nothing(rig: Rig, changed: Any, why: str) -> None:
    before = rig.plant.model
    assert why in str(put(rig, changed(rig.model)).refusal)
    assert rig.plant.model is before and taken(rig) == []
    assert all(run.following is None for run in rig.plant.cells.values())


def test_a_version_that_nobody_gave_is_refused(rig: Rig) -> None:
    rig.tell(Revision(at=rig.now, version=NEXT))
    answer = [each for each in rig.sent if isinstance(each, RevisionAnswer)][-1]
    assert "no version 2" in str(answer.refusal)


def wish(rig: Rig, *, wanted: bool) -> None:
    rig.tell(RestartRequest(at=rig.now, by="Ana", wanted=wanted))


def test_a_restart_waits_for_the_task_at_work_and_no_other_begins(rig: Rig) -> None:
    first, second = (rig.submit("sis_a 0B 0").task for _ in range(2))
    rig.wait(1.0)
    wish(rig, wanted=True)
    assert not rig.plant.may_restart
    assert rig.wait(200.0, until=lambda: ended(rig, first))
    rig.wait(5.0)
    assert rig.plant.may_restart and rig.plant.intake.tasks[second].state is TaskState.QUEUED
    why = reasons.of_waiting(rig.plant.cells["sis_a"])
    assert "restarts once all its cells rest" in str(why)


def test_a_restart_that_is_not_wanted_any_more_has_the_next_task_begin(rig: Rig) -> None:
    wish(rig, wanted=True)
    task = rig.submit("sis_a 0B 0").task
    rig.wait(5.0)
    assert rig.plant.intake.tasks[task].state is TaskState.QUEUED and rig.plant.may_restart
    wish(rig, wanted=False)
    rig.wait(1.0)
    assert rig.plant.intake.tasks[task].state is TaskState.RUNNING and not rig.plant.may_restart


def test_a_cell_that_is_taught_keeps_a_restart_waiting(rig: Rig) -> None:
    assert rig.operate(Verb.TEACH, "sis_a", teacher="ana") is None
    wish(rig, wanted=True)
    assert not rig.plant.may_restart
    assert rig.operate(Verb.AUTOMATIC, "sis_a") is None
    rig.wait(1.0)
    assert rig.plant.may_restart
