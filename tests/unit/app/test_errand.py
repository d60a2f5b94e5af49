from __future__ import annotations

from concurrent.futures import Future

import pytest

from arboleda.app.errand import Errand
from arboleda.model.messages import Reason, TaskChanged, TaskState


class FakePlant:
    """Answers what it is told to answer."""

    def __init__(self) -> None:
        self.asked: dict[str, Future[TaskChanged]] = {}

    def submit(self, text: str) -> Future[TaskChanged]:
        self.asked[text] = Future()
        return self.asked[text]

    def answer(self, text: str, state: TaskState = TaskState.QUEUED) -> None:
        self.asked[text].set_result(change(text, state))


def change(text: str, state: TaskState, reason: Reason | None = None) -> TaskChanged:
    task = "" if state is TaskState.REFUSED else f"t-{text}"
    return TaskChanged(task=task, text=text, cell=text.split()[0], state=state, reason=reason)


@pytest.fixture
def started() -> tuple[Errand, FakePlant, list[str]]:
    ends: list[str] = []
    errand = Errand(["sis_a 1", "sis_b 1", "sis_a 2"], lambda: ends.append("over"))
    plant = FakePlant()
    errand.start(plant.submit)
    for text in plant.asked:
        plant.answer(text)
    return errand, plant, ends


def test_it_is_over_once_when_every_task_is_done(started) -> None:
    errand, _, ends = started
    for text in ("sis_a 1", "sis_b 1", "sis_a 2"):
        assert not ends
        errand.changed(change(text, TaskState.RUNNING))
        errand.changed(change(text, TaskState.DONE))
    assert ends == ["over"] and errand.ok
    assert set(errand.seconds) == set(errand.results)


def test_an_id_whose_task_has_failed_before_is_not_done() -> None:
    ends: list[str] = []
    errand, plant = Errand(["sis_a 1"], lambda: ends.append("over")), FakePlant()
    errand.start(plant.submit)
    plant.answer("sis_a 1", TaskState.FAILED)
    assert ends == ["over"] and not errand.ok


def test_it_does_not_wait_for_tasks_that_a_held_cell_cannot_start(started) -> None:
    errand, _, ends = started
    errand.changed(change("sis_b 1", TaskState.DONE))
    errand.changed(change("sis_a 1", TaskState.FAILED, Reason.LINK_LOST))
    assert not ends
    for _ in range(2):
        errand.seen({"cells": [{"name": "sis_a", "paused": True, "task": None}]})
    assert ends == ["over"] and not errand.ok
    assert errand.results["t-sis_a 2"].state is TaskState.QUEUED


def test_tasks_of_others_do_not_matter(started) -> None:
    errand, _, ends = started
    errand.changed(change("sis_c 9", TaskState.DONE))
    assert not ends and "t-sis_c 9" not in errand.results


def test_a_refused_task_is_an_answer_too() -> None:
    ends: list[str] = []
    errand, plant = Errand(["sis_a 1"], lambda: ends.append("over")), FakePlant()
    errand.start(plant.submit)
    plant.answer("sis_a 1", TaskState.REFUSED)
    assert ends == ["over"] and not errand.ok
