from __future__ import annotations

from concurrent.futures import Future
from dataclasses import replace
from typing import Any

import pytest

from arboleda.cli.errand import Errand
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
        errand.note_snapshot(snapshot(sis_a={"paused": True}))
    assert ends == ["over"] and not errand.ok
    assert errand.results["t-sis_a 2"].state is TaskState.QUEUED


def snapshot(*offline: str, **cells: dict[str, Any]) -> dict[str, Any]:
    """Cells that are idle, each with an arm and a camera; `cells`: what of one is otherwise."""
    idle = {"paused": False, "task": None, "state": "idle", "not_ready": "an arm was not heard yet"}
    rows = [
        {
            "name": name,
            **idle,
            "devices": [{"name": f"arm_{name}"}, {"name": f"camera_{name}"}],
            **cells.get(name, {}),
        }
        for name in ("sis_a", "sis_b")
    ]
    robots = [
        {
            "name": each["name"],
            "online": each["name"] not in offline,
            "obstacle": f"{each['name']} is offline",
        }
        for row in rows
        for each in row["devices"]
    ]
    return {"cells": rows, "robots": robots}


class Waiting:
    """An errand that waits 10 s for devices, under time that is moved by hand."""

    def __init__(self, *texts: str, patience_s: float | None = 10.0) -> None:
        self.now, self.ends = 0.0, 0
        self.errand = Errand(texts, self._finished, patience_s=patience_s, clock=lambda: self.now)
        plant = FakePlant()
        self.errand.start(plant.submit)
        for text in plant.asked:
            plant.answer(text)

    def _finished(self) -> None:
        self.ends += 1

    def at(self, now: float, seen: dict[str, Any]) -> int:
        """How often it was over, once that is seen then."""
        self.now = now
        self.errand.note_snapshot(seen)
        return self.ends


def test_a_task_whose_devices_stay_offline_is_over_with_what_is_said_of_them_then() -> None:
    waiting = Waiting("sis_a 1")
    assert waiting.at(0.0, snapshot("arm_sis_a")) == 0
    assert waiting.at(9.9, snapshot("arm_sis_a", "arm_sis_b")) == 0
    assert waiting.at(10.0, snapshot("camera_sis_a", "arm_sis_b")) == 1
    assert [str(each) for each in waiting.errand.missing] == ["camera_sis_a is offline"]
    assert str(waiting.errand.results["t-sis_a 1"].sentence) == "camera_sis_a is offline"
    assert waiting.at(11.0, snapshot("camera_sis_a")) == 1 and not waiting.errand.ok


@pytest.mark.parametrize(
    "between",
    [
        snapshot(),
        snapshot("arm_sis_a", sis_a={"not_ready": None}),
        snapshot("arm_sis_a", sis_a={"task": {"id": "another"}}),
    ],
)
def test_a_device_that_comes_meanwhile_is_waited_for_anew(between: dict[str, Any]) -> None:
    waiting = Waiting("sis_a 1")
    gone = snapshot("arm_sis_a")
    assert [
        waiting.at(0.0, gone),
        waiting.at(5.0, between),
        waiting.at(6.0, gone),
        waiting.at(15.9, gone),
    ] == [0] * 4
    assert waiting.at(16.0, gone) == 1


def test_a_task_of_another_cell_is_waited_for_first() -> None:
    waiting = Waiting("sis_a 1", "sis_b 1")
    waiting.errand.changed(change("sis_b 1", TaskState.RUNNING))
    assert [waiting.at(at, snapshot("arm_sis_a")) for at in (0.0, 60.0)] == [0, 0]
    waiting.errand.changed(change("sis_b 1", TaskState.DONE))
    assert waiting.ends == 1 and [str(each) for each in waiting.errand.missing] == ["arm_sis_a is offline"]


def test_a_task_that_several_cells_may_do_is_over_where_none_can() -> None:
    waiting = Waiting("sis_a 1")
    waiting.errand.changed(replace(change("sis_a 1", TaskState.QUEUED), cell=None))
    assert [waiting.at(at, snapshot("arm_sis_a")) for at in (0.0, 60.0)] == [0, 0]
    both = snapshot("arm_sis_a", "arm_sis_b")
    assert [waiting.at(60.0, both), waiting.at(69.9, both), waiting.at(70.0, both)] == [0, 0, 1]


def test_who_stays_up_waits_without_end() -> None:
    waiting = Waiting("sis_a 1", patience_s=None)
    assert [waiting.at(at, snapshot("arm_sis_a")) for at in (0.0, 1e6)] == [0, 0]


HELD = {
    "task": {"id": "t-before"},
    "state": "held",
    "paused": True,
    "advice": ["retry", "abandon"],
    "waiting_for": "sis_a is held; retry sis_a or abandon sis_a",
}


def test_a_task_behind_one_of_an_earlier_start_is_over_with_what_is_said_to_it() -> None:
    waiting = Waiting("sis_a 1", "sis_b 1")
    assert waiting.at(0.0, snapshot(sis_a=HELD)) == 0
    waiting.errand.changed(change("sis_b 1", TaskState.DONE))
    assert waiting.ends == 1 and waiting.errand.needs_person and not waiting.errand.ok
    assert waiting.errand.results["t-sis_a 1"].sentence == HELD["waiting_for"]


@pytest.mark.parametrize("otherwise", [{"advice": []}, {"state": "execute"}, {"task": {"id": "t-sis_a 1"}}])
def test_a_cell_that_may_still_go_on_by_itself_is_waited_for(otherwise: dict[str, Any]) -> None:
    waiting = Waiting("sis_a 1", "sis_a 2")
    assert [waiting.at(at, snapshot(sis_a=HELD | otherwise)) for at in (0.0, 60.0)] == [0, 0]


def test_a_device_of_an_earlier_task_is_waited_for_before_a_person_decides() -> None:
    waiting = Waiting("sis_a 1")
    gone = snapshot("arm_sis_a", sis_a=HELD)
    assert [waiting.at(0.0, gone), waiting.at(9.9, gone), waiting.at(10.0, gone)] == [0, 0, 1]
    assert [str(each) for each in waiting.errand.missing] == ["arm_sis_a is offline"]


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
