"""A plant beside which something hangs, and robots that note what reaches them meanwhile."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Protocol

import pytest

from arboleda.departures.leaving import ends_motion
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import TaskChanged
from arboleda.runtime.parts import plant_log
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.store.sqlite import Store
from arboleda.testing.plants import shipped

MODEL = shipped("sis_a", "sis_b")
ROBOTS = set(MODEL.robots)


class Gate(Protocol):
    """Something that hangs while it is shut and somebody comes through it."""

    shut: bool

    @property
    def hangs(self) -> bool: ...

    def __call__(self, *_: object) -> None: ...


class Robots:
    """The port to the robots, on ROS 2 as well: what was sent, and who was stopped while a gate hung."""

    watched, diagnosed = True, False

    def __init__(self, gate: Gate) -> None:
        self.gate = gate
        self.messages: list[Any] = []
        self.stopped_while_it_hung: set[str] = set()
        self.all_stopped = threading.Event()
        self.on_change: Callable[[], None] = lambda: None

    def send(self, message: Any) -> None:
        self.messages.append(message)
        if isinstance(message, TaskChanged):
            self.on_change()
        elif ends_motion(message) and self.gate.hangs:
            self.stopped_while_it_hung.add(message.robot)
            if self.stopped_while_it_hung == ROBOTS:
                self.all_stopped.set()

    def check_alone(self) -> None: ...

    def publish_view(self, _view: dict[str, Any]) -> Iterator[None]:
        yield


class HangingHandler(logging.Handler):
    """An output of the log that hangs, and with it the lock that all who log take."""

    def __init__(self, gate: Gate) -> None:
        super().__init__()
        self._gate = gate

    def emit(self, _record: logging.LogRecord) -> None:
        self._gate()


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store(tmp_path / "plant.sqlite") as opened:
        yield opened


@pytest.fixture
def robots(gate: Gate) -> Robots:
    return Robots(gate)


@pytest.fixture
def crashes() -> list[BaseException]:
    return []


def made(store: Store, robots: Robots, crashes: list[BaseException]) -> Orchestrator:
    plant = Orchestrator(MODEL, 7, lambda name, error: crashes.append(error), store)
    plant.connect(robots)
    return plant


def hang_before(gate: Gate, owner: Any, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    real = getattr(owner, name)
    monkeypatch.setattr(owner, name, lambda *args, **named: (gate(), real(*args, **named))[1])


def commit_of_a_task(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    hang_before(gate, plant.keeping.store.tasks, "keep", monkeypatch)


def log(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plant_log.TASKS, "isEnabledFor", lambda level: True)
    monkeypatch.setattr(plant_log.TASKS, "handlers", [HangingHandler(gate)])


def fail(*_: object, **__: object) -> None:
    raise ArboledaError("The disk is full.")
