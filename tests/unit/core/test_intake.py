"""What is remembered of tasks, and which of them begin by no other version of the plant."""

from __future__ import annotations

from dataclasses import replace
from typing import NoReturn

import pytest

from arboleda.core.intake import HISTORY, Intake
from arboleda.core.plant import Plant
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import KeptTask, Revision, RevisionName, TaskChanged, TaskRequest, TaskState
from arboleda.model.task import Order, Task
from arboleda.testing import shipped


def best(orders: object) -> NoReturn:
    raise ArboledaError("there is nothing to choose")


@pytest.fixture
def intake() -> Intake:
    return Intake(shipped("sis_a"), epoch=7)


def remembered(intake: Intake, id: str, *, ended: bool) -> Task:
    task = intake.task(f"sis_a palletizing #{id}", best)
    intake.remember(task)
    if ended:
        task.become(TaskState.RUNNING, 1.0)
        task.become(TaskState.DONE, 2.0)
    return task


def test_the_oldest_task_that_has_ended_is_forgotten_not_one_that_waits(intake: Intake) -> None:
    remembered(intake, "waits", ended=False)
    for number in range(HISTORY):
        remembered(intake, f"lot{number}", ended=True)
    assert len(intake.tasks) == HISTORY
    assert "waits" in intake.tasks and "lot0" not in intake.tasks and "lot1" in intake.tasks


def test_no_task_that_waits_is_forgotten_however_many_do(intake: Intake) -> None:
    for number in range(HISTORY + 2):
        remembered(intake, f"lot{number}", ended=False)
    last = intake.task(f"sis_a palletizing #lot{HISTORY + 1}", best)
    assert intake.knows(last) and len(intake.tasks) == HISTORY + 2


def test_a_task_is_forgotten_only_past_the_limit(intake: Intake) -> None:
    for number in range(HISTORY):
        remembered(intake, f"lot{number}", ended=True)
    assert "lot0" in intake.tasks


def test_a_default_recipe_without_values_is_named_and_known_as_earlier_versions_kept_it() -> None:
    model = shipped("sis_a")
    cell = replace(model.cells[0], recipes=(replace(model.cells[0].recipe("palletizing"), is_default=True),))
    intake = Intake(replace(model, cells=(cell,)), epoch=7)
    task = intake.task("sis_a #lot1", best)
    assert (task.order.text, task.order.short) == ("sis_a palletizing", "sis_a")
    kept = Task("lot1", Order(text="sis_a", cell="sis_a", recipe="palletizing"))
    intake.remember(kept)
    assert intake.task("sis_a palletizing #lot1", best) is kept, "a finished order is not done twice"


TEXT = "sis_a 0B 7 #lot1"
FIRST, SECOND = (RevisionName(digest=each, number=number) for number, each in enumerate(("one", "two"), 1))


def revision(version: RevisionName) -> Revision:
    return Revision(at=0.0, version=version)


def request(version: str) -> TaskRequest:
    return TaskRequest(at=0.0, text=TEXT, request="r", version=version)


@pytest.fixture
def plant() -> Plant:
    model = shipped("sis_a")
    return Plant(model, epoch=1, now=0.0, versions={"one": model, "two": model})


def states(plant: Plant, *events: Revision | TaskRequest) -> list[TaskState]:
    """The states that the task was told to have, in their order."""
    told = [each for event in events for each in plant.step(0.0, [event])]
    return [each.state for each in told if isinstance(each, TaskChanged)]


def test_a_request_for_the_version_at_work_is_taken(plant: Plant) -> None:
    assert states(plant, revision(FIRST), request("one")) == [TaskState.QUEUED]


def test_a_request_that_comes_after_another_version_is_refused(plant: Plant) -> None:
    assert states(plant, revision(FIRST), revision(SECOND), request("one")) == [TaskState.REFUSED]


def test_one_that_waits_ends_with_its_version_and_one_for_any_waits_on(plant: Plant) -> None:
    assert states(plant, request("one"), revision(FIRST)) == [TaskState.QUEUED]
    assert states(plant, revision(SECOND)) == [TaskState.CANCELLED]
    other = Plant(plant.model, epoch=1, now=0.0, versions=plant.versions)
    assert states(other, request(""), revision(FIRST), revision(SECOND)) == [TaskState.QUEUED]


@pytest.mark.parametrize(("is_bound", "state"), [(True, TaskState.CANCELLED), (False, TaskState.QUEUED)])
def test_one_that_had_not_begun_ends_with_the_start_it_was_allowed_in(
    is_bound: bool, state: TaskState
) -> None:
    kept = KeptTask(id="lot1", text=TEXT, cell="sis_a", state=TaskState.QUEUED, is_bound=is_bound)
    plant = Plant(shipped("sis_a"), epoch=2, now=0.0, kept=[kept])
    assert plant.intake.tasks["lot1"].state is state
