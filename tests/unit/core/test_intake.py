"""What is remembered of tasks: all that have not ended, and the last of those that have."""

from __future__ import annotations

from typing import NoReturn

import pytest

from arboleda.core.intake import HISTORY, Intake
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import TaskState
from arboleda.model.task import Task
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
