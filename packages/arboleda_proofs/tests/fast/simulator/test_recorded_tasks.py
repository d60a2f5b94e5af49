"""Tasks that ended long ago, in the record."""

from __future__ import annotations

import pytest

from arboleda.model.messages import Check, KeptTask, TaskChanged, TaskState
from arboleda_proofs.simulator.recorded.tasks import SURE, Tasks


def say(tasks: Tasks, id: str, state: TaskState, *, is_repeated: bool = False) -> None:
    said = TaskChanged(task=id, text="sis_a 0B 7", cell="sis_a", state=state)
    tasks.take(said, 0.0, is_repeated=is_repeated)


@pytest.fixture
def tasks() -> Tasks:
    """One task that ended before more others than the record is sure about."""
    tasks = Tasks(["sis_a"])
    for number in range(SURE + 100):
        for state in (TaskState.QUEUED, TaskState.RUNNING, TaskState.DONE):
            say(tasks, f"lot{number}", state)
    tasks.clear_news()
    return tasks


def test_an_old_task_that_is_asked_for_again_is_answered_with_how_it_ended(tasks: Tasks) -> None:
    say(tasks, "lot0", TaskState.DONE, is_repeated=True)
    assert [(change.before, change.answer) for change in tasks.changes] == [(TaskState.DONE, True)]


def test_an_old_task_that_ends_once_more_is_no_answer(tasks: Tasks) -> None:
    say(tasks, "lot0", TaskState.DONE)
    say(tasks, "lot1", TaskState.FAILED, is_repeated=True)
    assert [change.answer for change in tasks.changes] == [False, False]


def test_an_old_id_that_the_plant_has_forgotten_may_be_a_new_task(tasks: Tasks) -> None:
    say(tasks, "lot0", TaskState.QUEUED, is_repeated=True)
    assert [(change.before, change.answer) for change in tasks.changes] == [(None, False)]


def test_of_a_task_that_nobody_told_to_be_done_the_row_on_the_disk_says_what_nobody_checked() -> None:
    tasks = Tasks(["sis_a"])
    row = KeptTask(
        id="lot", text="sis_a 0B 7", cell="sis_a", state=TaskState.DONE, ended_at=1.0, unchecked=(Check.GRIP,)
    )
    tasks.restart([row], 2.0)
    known = tasks.known("lot")
    assert known is not None and known.message.sentence
