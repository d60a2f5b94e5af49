"""Stops leave whatever hangs, before what is older; nobody is told what is not kept."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.core.leaving import StopLeft, ends_motion
from arboleda.core.plant import Plant
from arboleda.kinds.arm import SetEffector
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import (
    Fact,
    Heartbeat,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    TaskChanged,
    Undelivered,
    Verb,
)
from arboleda.runtime.parts import orchestrator
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.store.sqlite import Store
from arboleda.testing.plants import shipped

MODEL = shipped("sis_a", "sis_b")
ROBOTS = set(MODEL.robots)


class Gate:
    """Something that hangs: once `shut`, the first who comes through stays until all else is done."""

    def __init__(self) -> None:
        self.shut = self.hangs = False
        self.meanwhile: Callable[[], None] = lambda: None

    def __call__(self, *_: object) -> None:
        if self.shut:
            self.shut, self.hangs = False, True
            self.meanwhile()
            self.hangs = False


class Robots:
    """The port to the robots, on ROS 2 as well: what was sent, and who was stopped while a gate hung."""

    watched, diagnosed = True, False

    def __init__(self, gate: Gate) -> None:
        self.gate = gate
        self.messages: list[Any] = []
        self.stopped_while_it_hung: set[str] = set()
        self.on_change: Callable[[], None] = lambda: None

    def send(self, message: Any) -> None:
        self.messages.append(message)
        if isinstance(message, TaskChanged):
            self.on_change()
        elif ends_motion(message) and self.gate.hangs:
            self.stopped_while_it_hung.add(message.robot)

    def check_alone(self) -> None: ...

    def publish_view(self, _view: dict[str, Any]) -> Iterator[None]:
        yield


@pytest.fixture
def gate() -> Gate:
    return Gate()


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


@pytest.fixture
def plant(store: Store, robots: Robots, crashes: list[BaseException]) -> Orchestrator:
    made = Orchestrator(MODEL, 7, lambda name, error: crashes.append(error), store)
    made.connect(robots)
    made.connect_ros(robots)
    return made


class HangingHandler(logging.Handler):
    """An output of the log that hangs, and with it the lock that all who log take."""

    def __init__(self, gate: Gate) -> None:
        super().__init__()
        self._gate = gate

    def emit(self, _record: logging.LogRecord) -> None:
        self._gate()


def hang_before(gate: Gate, owner: Any, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    real = getattr(owner, name)
    monkeypatch.setattr(owner, name, lambda *args, **named: (gate(), real(*args, **named))[1])


def commit_of_a_task(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    hang_before(gate, plant._store, "task", monkeypatch)


def database_that_is_asked_who_leads(
    plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch
) -> None:
    hang_before(gate, plant._store, "confirm", monkeypatch)


def recorder(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    plant.recorder = SimpleNamespace(trouble="", stepped=gate, saw=gate)


def log(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orchestrator.TASKS, "isEnabledFor", lambda level: True)
    monkeypatch.setattr(orchestrator.TASKS, "handlers", [HangingHandler(gate)])


def listener(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    plant.listeners.append(gate)


def observer(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    plant.observers.append(gate)


def task_status_on_ros(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    plant._port.on_change = gate


HANGS = [
    commit_of_a_task,
    database_that_is_asked_who_leads,
    recorder,
    log,
    listener,
    observer,
    task_status_on_ros,
]


def by_http(plant: Orchestrator) -> Future[OperatorAnswer]:
    return plant.operate(Verb.STOP)


def by_ros(plant: Orchestrator) -> None:
    plant.hear(OperatorRequest(at=orchestrator.clock.seconds(), verb=Verb.STOP, request="of a service"))


@pytest.mark.parametrize("ask", [by_http, by_ros])
@pytest.mark.parametrize("hang", HANGS)
def test_every_robot_is_told_to_stop_while_something_hangs(
    plant, gate, robots, monkeypatch, hang, ask
) -> None:
    def meanwhile() -> None:
        ask(plant)
        plant.stops.loop.turn()

    hang(plant, gate, monkeypatch)
    gate.shut, gate.meanwhile = True, meanwhile
    plant.submit("sis_a 0B 1")
    plant.loop.turn()
    assert robots.stopped_while_it_hung == ROBOTS


class Script(Plant):
    """A plant that says what it is told to."""

    says: Sequence[Any] = ()

    def step(self, now: float, events: Any) -> list[Any]:
        self.heard = list(events)
        return list(self.says)


@pytest.fixture
def scripted(monkeypatch, store, robots, crashes) -> Orchestrator:
    monkeypatch.setattr(orchestrator, "Plant", Script)
    made = Orchestrator(MODEL, 7, lambda name, error: crashes.append(error), store)
    made.connect(robots)
    return made


ON = SetEffector(id="7-1", robot="ra1", on=True)
OTHERS = SetEffector(id="7-2", robot="ra2", on=True)
GRIP = Remember(fact=Fact.EFFECTOR, name="ra1", value="switching")


def turn(plant: Orchestrator, *messages: Any) -> list[Any]:
    plant.plant.says = list(messages)
    plant.loop.turn()
    return plant.plant.heard


def commands(robots: Robots) -> list[Command]:
    return [each for each in robots.messages if isinstance(each, Command)]


def test_a_command_that_waits_for_its_commit_does_not_leave_after_a_stop(
    scripted, robots, store, monkeypatch
) -> None:
    keep = store.keep
    monkeypatch.setattr(store, "keep", lambda *facts: (keep(*facts), scripted.operate(Verb.STOP, "ra1")))
    turn(scripted, GRIP, ON, OTHERS)
    scripted.stops.loop.turn()
    sent = commands(robots)
    assert sent[0] == OTHERS and [type(each) for each in sent[1:]] == [Stop]
    events = turn(scripted)
    (undelivered,) = [each for each in events if isinstance(each, Undelivered)]
    assert undelivered.id == ON.id
    assert str(undelivered.sentence) == "a stop of ra1 left before this could be sent"


def test_a_command_that_leaves_in_the_same_moment_as_a_stop_is_stopped_again(scripted, robots) -> None:
    send = robots.send

    def publish(message: Any) -> None:
        if message is ON:
            scripted.operate(Verb.STOP, "ra1")
            scripted.stops.loop.turn()
        send(message)

    robots.send = publish
    turn(scripted, ON)
    scripted.stops.loop.turn()
    first, second, third = commands(robots)
    assert (type(first), second, type(third)) == (Stop, ON, Stop)
    assert first.id != third.id


def test_what_is_made_after_a_stop_is_not_overtaken_by_it(scripted, robots) -> None:
    future = scripted.operate(Verb.STOP, "ra1")
    (token,) = scripted.stops.ahead
    clear = Stop(id="7-9", robot="ra1", mode=StopMode.CLEAR)
    turn(scripted, OperatorAnswer(verb=Verb.STOP, scope="ra1", request=token), clear)
    assert clear in robots.messages and future.done()
    assert not scripted.stops.ahead


def test_a_plant_whose_lease_is_over_asks_before_it_stops(scripted, robots, store, monkeypatch) -> None:
    monkeypatch.setattr(type(store), "leads_for_certain", False)
    monkeypatch.setattr(scripted.loop, "busy", True)
    scripted.operate(Verb.STOP)
    scripted.stops.loop.turn()
    assert commands(robots) == []


def test_a_plant_that_another_process_leads_sends_no_stop_beside_its_steps(
    scripted, robots, store, crashes, monkeypatch
) -> None:
    def superseded() -> None:
        raise orchestrator.Superseded("Another process leads.")

    monkeypatch.setattr(store, "confirm", superseded)
    turn(scripted, Heartbeat(epoch=7))
    monkeypatch.setattr(scripted.loop, "busy", True)
    scripted.operate(Verb.STOP)
    scripted.stops.loop.turn()
    assert crashes and robots.messages == []


def fail(*_: object, **__: object) -> None:
    raise ArboledaError("The disk is full.")


def test_a_stop_that_cannot_be_kept_is_told_to_have_left(scripted, robots, store, monkeypatch) -> None:
    monkeypatch.setattr(store, "keep", fail)
    future = scripted.operate(Verb.STOP, "ra1")
    (token,) = scripted.stops.ahead
    latch = Remember(fact=Fact.LATCH, name="ra1", value="on")
    stop = Stop(id="7-3", robot="ra1", mode=StopMode.LATCH)
    turn(scripted, latch, stop, OperatorAnswer(verb=Verb.STOP, scope="ra1", request=token))
    said = future.result(0)
    assert isinstance(said, StopLeft) and "The disk is full." in str(said.why)
    assert robots.messages == [stop, said]  # who asked over ROS 2 hears the same
