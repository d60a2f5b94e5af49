"""Stops leave whatever hangs, before what is older; nobody is told what is not kept."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.departures import stop_lane
from arboleda.departures.leaving import StopLeft, Unkept
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Fact, OperatorAnswer, TaskChanged, TaskState, Verb
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.parts.screens import KeptStateUnknown
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskQuery

from ..patience import SOON_S
from ..unit.runtime.hanging import ROBOTS, Robots, commit_of_a_task, fail, hang_before, log, made
from ..unit.runtime.hanging import crashes as crashes
from ..unit.runtime.hanging import robots as robots
from ..unit.runtime.hanging import store as store


class Gate:
    """Something that hangs: once `shut`, who comes through it waits until it is opened."""

    def __init__(self) -> None:
        self.shut = False
        self.reached = threading.Event()
        self._opened = threading.Event()

    def __call__(self, *_: object) -> None:
        if self.shut and not self._opened.is_set():
            self.reached.set()
            assert self._opened.wait(SOON_S), "nobody has let it go on"

    @property
    def hangs(self) -> bool:
        return self.reached.is_set() and not self._opened.is_set()

    def open(self) -> None:
        self._opened.set()


@pytest.fixture
def gate() -> Iterator[Gate]:
    gate = Gate()
    yield gate
    gate.open()


@pytest.fixture
def plant(store: Store, robots: Robots, crashes: list[BaseException], gate: Gate) -> Iterator[Orchestrator]:
    plant = made(store, robots, crashes)
    plant.connect_ros(robots)
    yield plant
    gate.open()
    plant.stop()


def page(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    plant.screens.watchers.append(gate)


HANGS = [commit_of_a_task, log, page]


@pytest.mark.parametrize("hang", HANGS)
def test_every_robot_is_told_to_stop_while_something_hangs(plant, gate, robots, monkeypatch, hang) -> None:
    monkeypatch.setattr(stop_lane, "ANSWERED_WITHIN_S", 0.0)
    hang(plant, gate, monkeypatch)
    plant.start()
    gate.shut = True
    plant.submit("sis_a 0B 1")
    assert gate.reached.wait(SOON_S)
    answer = plant.operate(Verb.STOP)
    assert robots.all_stopped.wait(SOON_S)
    assert gate.hangs
    said = answer.result(SOON_S)
    assert isinstance(said, StopLeft) and "has not kept it" in str(said.why)
    assert gate.hangs


def test_a_stop_leaves_before_the_commit_of_its_own_latch(plant, gate, robots, store, monkeypatch) -> None:
    monkeypatch.setattr(stop_lane, "ANSWERED_WITHIN_S", 0.0)
    plant.start()
    monkeypatch.setattr(robots, "gate", SimpleNamespace(hangs=True))
    hang_before(gate, store, "keep", monkeypatch)
    gate.shut = True
    answer = plant.operate(Verb.STOP)
    assert robots.all_stopped.wait(SOON_S)
    assert gate.reached.wait(SOON_S)
    assert store.facts(Fact.LATCH) == {}
    assert isinstance(answer.result(SOON_S), StopLeft)
    gate.open()
    plant.stop()
    assert store.facts(Fact.LATCH) == dict.fromkeys(ROBOTS, "on")


def test_an_act_that_has_happened_says_so_though_the_disk_hangs(plant, gate, store, monkeypatch) -> None:
    monkeypatch.setattr(stop_lane, "ANSWERED_WITHIN_S", 0.0)
    plant.start()
    hang_before(gate, store, "sync", monkeypatch)
    gate.shut = True
    answer = plant.operate(Verb.LOAD, "sis_b", arguments=(("place", "station_4"),))
    assert gate.reached.wait(SOON_S)
    said = answer.result(SOON_S)
    assert isinstance(said, Unkept) and "load sis_b is done, and the plant has not kept it" in str(said.why)
    assert gate.hangs


def test_whoever_asks_a_plant_that_is_free_hears_that_the_stop_is_kept(plant, robots, store) -> None:
    plant.start()
    said = plant.operate(Verb.STOP).result(SOON_S)
    assert type(said) is OperatorAnswer and said.refusal is None
    assert store.facts(Fact.LATCH) == dict.fromkeys(ROBOTS, "on")


def states(plant: Orchestrator, task: str) -> tuple[str | None, list[str]]:
    """A task as a client finds it, and as it is in a snapshot."""
    found = plant.screens.find(task)
    rows = plant.screens.snapshot()["tasks"]
    return found and found["state"], [row["state"] for row in rows if row["id"] == task]


@pytest.mark.parametrize("kept", ["task", "fact"])
def test_nobody_is_told_what_is_not_kept_yet(plant, gate, robots, store, monkeypatch, kept) -> None:
    views: list[dict[str, Any]] = []
    shown = threading.Condition()

    def watch(snapshot: dict[str, Any]) -> None:
        with shown:
            views.append(snapshot)
            shown.notify_all()

    plant.screens.watchers.append(watch)
    plant.start()
    assert plant.submit("sis_a 0B 1 #a").result(SOON_S).state is TaskState.QUEUED
    with shown:
        assert shown.wait_for(lambda: views and views[-1]["tasks"], SOON_S)
    hang_before(gate, store.tasks if kept == "task" else store, "keep", monkeypatch)
    gate.shut = True
    plant.operate(Verb.CANCEL, "a") if kept == "task" else plant.operate(Verb.STOP, "sis_b")
    assert gate.reached.wait(SOON_S)
    assert states(plant, "a") == ("queued", ["queued"])
    assert all(robot["latched"] is False for robot in plant.screens.snapshot()["robots"])
    with pytest.raises(KeptStateUnknown, match="ask again later"):
        plant.screens.find("of nobody")
    assert {row["state"] for each in views for row in each["tasks"]} == {"queued"}
    gate.open()
    plant.stop()
    assert views[-1]["ending"]


def test_once_something_cannot_be_kept_screens_see_what_was_kept_last(
    plant, robots, store, crashes, monkeypatch
) -> None:
    views: list[dict[str, Any]] = []
    changes: list[TaskChanged] = []
    seen_by_observers: list[str] = []
    plant.screens.watchers.append(views.append)
    plant.listeners.append(changes.append)
    published: list[dict[str, Any]] = []
    robots.publish_view = lambda snapshot: iter(published.append(snapshot) or ())
    plant.start()
    plant.submit("sis_a 0B 1 #a").result(SOON_S)
    assert plant.screens.snapshot()["tasks"]
    for table in (store, store.tasks, store.acts):
        monkeypatch.setattr(table, "keep", fail)
    plant.observers.append(lambda each: seen_by_observers.append(each.intake.tasks["a"].state.value))
    with pytest.raises(ArboledaError, match="The disk is full"):
        plant.operate(Verb.CANCEL, "a").result(SOON_S)
    assert crashes
    found = plant.screens.snapshot()
    assert found["ending"]
    assert [row["state"] for row in found["tasks"]] in ([], ["queued"])  # as it was published last
    plant.stop()
    told = [row["state"] for each in (*views, *published) for row in each["tasks"]]
    assert "cancelled" not in told and "failed" not in told
    assert [each.state for each in changes] == [TaskState.QUEUED]
    assert views[-1]["ending"] and published[-1]["ending"]
    assert seen_by_observers == []
    assert [row.state for row in store.tasks.select(TaskQuery())] == ["queued"]
