"""What an earlier start accepted is found again: it waits, or it has failed, and nothing is done twice."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.core.plant import Plant
from arboleda.model.messages import (
    Failure,
    KeptTask,
    OperatorRequest,
    Reason,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.model.sentence import OWN
from arboleda.testing.plants import shipped


def kept(id: str, text: str, state: TaskState = TaskState.QUEUED, **more: object) -> KeptTask:
    return KeptTask(id=id, text=text, cell=text.split()[0], state=state, **more)  # type: ignore[arg-type]


def start(*tasks: KeptTask, **changes: object) -> Plant:
    model = shipped()
    cells = tuple(replace(cell, **changes) for cell in model.cells)
    return Plant(replace(model, cells=cells), epoch=2, now=100.0, kept=tasks)


def changes(plant: Plant, *events: object) -> list[TaskChanged]:
    return [each for each in plant.step(plant.now, events) if isinstance(each, TaskChanged)]


def test_tasks_that_waited_wait_again_in_their_order_with_their_ids() -> None:
    plant = start(kept("a", "sis_a 0B 1"), kept("b", "sis_b 0B 2"), kept("c", "sis_a 1B 3"))
    assert [task.id for task in plant.cells["sis_a"].queue] == ["a", "c"]
    assert [task.id for task in plant.cells["sis_b"].queue] == ["b"]


def test_nothing_starts_before_somebody_resumes_and_the_cell_says_so() -> None:
    plant = start(kept("a", "sis_a 0B 1"))
    run = plant.cells["sis_a"]
    plant.step(100.0, ())
    assert run.queue.paused
    assert str(run.queue.why_paused) == "1 task of an earlier start waits in sis_a; resume sis_a starts it"
    plant.step(100.1, [OperatorRequest(at=100.1, verb=Verb.RESUME, scope="sis_a")])
    assert not run.queue.paused
    assert not plant.cells["sis_b"].queue.paused


def test_a_cell_that_goes_on_by_itself_is_not_paused() -> None:
    assert not start(kept("a", "sis_a 0B 1"), goes_on=True).cells["sis_a"].queue.paused


def test_a_task_that_was_at_work_has_failed_and_pauses_even_a_cell_that_goes_on() -> None:
    plant = start(kept("a", "sis_a 0B 1", TaskState.RUNNING), kept("b", "sis_a 0B 2"), goes_on=True)
    (told,) = changes(plant)
    assert (told.task, told.state, told.reason) == ("a", TaskState.FAILED, Reason.INTERRUPTED)
    assert plant.cells["sis_a"].queue.paused
    assert [task.id for task in plant.cells["sis_a"].queue] == ["b"]


@pytest.mark.parametrize("text", ["sis_a 9Z 1", "sis_x 0B 1", "sis_a bake 5"])
def test_a_task_that_the_plant_file_no_longer_knows_is_cancelled_with_the_reason(text: str) -> None:
    plant = start(kept("a", text))
    (told,) = changes(plant)
    assert (told.task, told.state, told.reason) == ("a", TaskState.CANCELLED, Reason.PRECONDITION)
    assert str(told.sentence).startswith("the plant as it is now does not take it: ")


def test_an_id_of_an_earlier_start_is_the_same_task() -> None:
    failure = Failure(reason=Reason.DEADLINE, sentence=OWN(text="too late"))
    done = kept("order-1", "sis_a 0B 1", TaskState.DONE, started_at=10.0, ended_at=20.0)
    failed = kept("order-2", "sis_a 0B 2", TaskState.FAILED, ended_at=30.0, failure=failure)
    plant = start(done, failed)
    again = [TaskRequest(at=100.0, text=f"{each.text} #{each.id}") for each in (done, failed)]
    first, second = changes(plant, *again)
    assert (first.task, first.state) == ("order-1", TaskState.DONE)
    assert (second.state, second.reason, str(second.sentence)) == (
        TaskState.FAILED,
        Reason.DEADLINE,
        "too late",
    )
    assert not any(cell.queue for cell in plant.cells.values())


def test_an_id_of_an_earlier_start_is_refused_for_another_task() -> None:
    plant = start(kept("order-1", "sis_a 0B 1", TaskState.DONE, ended_at=20.0))
    (told,) = changes(plant, TaskRequest(at=100.0, text="sis_a 0B 2 #order-1"))
    assert told.state is TaskState.REFUSED


def test_more_tasks_than_the_limit_are_all_taken_back() -> None:
    many = [kept(f"n{number}", "sis_a 0B 1") for number in range(3)]
    plant = start(*many, queue_limit=1)
    assert len(plant.cells["sis_a"].queue) == 3
    (told,) = changes(plant, TaskRequest(at=100.0, text="sis_a 0B 1"))
    assert told.state is TaskState.REFUSED
