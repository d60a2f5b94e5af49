"""Stops leave whatever hangs, before what is older; nobody is told what is not kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.core.plant import Plant
from arboleda.departures.leaving import StopLeft
from arboleda.kinds.arm import SetEffector
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import (
    Fact,
    Heartbeat,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    Undelivered,
    Verb,
)
from arboleda.runtime.parts import orchestrator
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.store.lead import Superseded
from arboleda.store.sqlite import Store

from .hanging import Robots, commit_of_a_task, fail, hang_before, log, made
from .hanging import crashes as crashes
from .hanging import robots as robots
from .hanging import store as store


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


@pytest.fixture
def gate() -> Gate:
    return Gate()


@pytest.fixture
def plant(store: Store, robots: Robots, crashes: list[BaseException]) -> Orchestrator:
    plant = made(store, robots, crashes)
    plant.connect_ros(robots)
    return plant


def database_that_is_asked_who_leads(
    plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch
) -> None:
    hang_before(gate, plant.keeping.store, "confirm", monkeypatch)


def recorder(plant: Orchestrator, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    plant.screens.recorder = SimpleNamespace(trouble="", stepped=gate, saw=gate)


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
    assert robots.all_stopped.is_set()


class Script(Plant):
    """A plant that says what it is told to."""

    says: Sequence[Any] = ()

    def step(self, now: float, events: Any) -> list[Any]:
        self.heard = list(events)
        return list(self.says)


@pytest.fixture
def scripted(monkeypatch, store, robots, crashes) -> Orchestrator:
    monkeypatch.setattr(orchestrator, "Plant", Script)
    return made(store, robots, crashes)


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
    monkeypatch.setattr(type(store.lead), "is_certain", False)
    monkeypatch.setattr(scripted.loop, "busy", True)
    scripted.operate(Verb.STOP)
    scripted.stops.loop.turn()
    assert commands(robots) == []


def test_a_plant_that_another_process_leads_sends_no_stop_beside_its_steps(
    scripted, robots, store, crashes, monkeypatch
) -> None:
    def superseded() -> None:
        raise Superseded("Another process leads.")

    monkeypatch.setattr(store, "confirm", superseded)
    turn(scripted, Heartbeat(epoch=7))
    monkeypatch.setattr(scripted.loop, "busy", True)
    scripted.operate(Verb.STOP)
    scripted.stops.loop.turn()
    assert crashes and robots.messages == []


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
