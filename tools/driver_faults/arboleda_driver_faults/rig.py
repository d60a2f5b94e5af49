"""A plant with one driver under the faults of its virtual controller, seed by seed.

The core, the supervisor and the driver are the shipped ones; everything is in one process under a clock that
is moved from deadline to deadline, a minute in a second. What the plant says of a task is held against what
the virtual device truly did.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from random import Random
from typing import Protocol

from arboleda.drivers.supervisor import (
    Begin,
    CommandRequest,
    DriverOutput,
    Give,
    Life,
    SendResult,
    Supervisor,
)
from arboleda.engine import Plant
from arboleda.model.advice import Hand
from arboleda.model.commands import Command
from arboleda.model.messages import (
    ENDED,
    Event,
    Heartbeat,
    OperatorRequest,
    Reason,
    Report,
    TaskChanged,
    TaskRequest,
    TaskState,
    Undelivered,
    Verb,
)
from arboleda.model.plant_model import PlantModel, Robot
from arboleda.model.sentence import OWN
from arboleda.rig.disk import Disk
from arboleda_drivers.virtual.faults import Faults

START_S, EPOCH = 100.0, 7
TASKS = 4
LOOKS_S = 1.0  # period of looks at the plant's advice
PATIENCE_S = 240.0  # after the last fault, for the last task

Hear = Callable[[Report], None]
Causes = Mapping[str, set[Reason]]


class Loopback(Protocol):
    """Driver and virtual device, connected: each gets the other's messages at once."""

    @property
    def next_deadline(self) -> float: ...

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""


class Rig(ABC):
    """Test of a device behind a driver: the connection, the tasks, and the true state of the device.

    `causes` are the reasons for which a task may fail while a fault is there, or soon after it; `work` is
    what must have been seen, in this order, where a task is done.
    """

    model: PlantModel
    driver: str
    causes: Causes
    work: Sequence[Hashable]
    between_s = 8.0  # two tasks
    tells_homing = True  # the driver hears of a homing at the device's own controls
    after_s = 20.0  # a fault may cause failures for so long: longer than any command of the task

    def __init__(self, faults: Mapping[str, str]) -> None:
        self.faults = Faults(faults)

    @property
    @abstractmethod
    def robots(self) -> Sequence[Robot]:
        """The robots behind the driver."""

    @abstractmethod
    def task(self, number: int) -> str:
        """The text of a task."""

    @abstractmethod
    def join(self, hear: Hear, now: float) -> Loopback:
        """A new driver, connected to the device, whose reports go to `hear`."""

    @abstractmethod
    def place(self) -> Hashable | None:
        """The true place of the device and its load; None at a place that does not matter."""

    def before_home(self) -> None:  # noqa: B027 - most devices find their reference by themselves
        """Do at the device what a person has to do there before it may be said to be homed."""

    @abstractmethod
    def moves(self) -> tuple[int, int]:
        """The number of moves that the device was told, and of those that the driver was given."""

    @property
    def where(self) -> Hashable:
        """The true position of the robot, which is another one at each moment while the robot moves."""
        raise NotImplementedError(f"{self.driver} moves no robot")

    def bystanders(self, now: float) -> list[Report]:
        """The reports of other devices of the cell, which take no part in the test."""
        return []

    def by_hand(self) -> None:  # noqa: B027 - most devices need nobody
        """Do at the device what a person would do there once all faults are gone."""


@dataclass(frozen=True, kw_only=True)
class FaultPeriod:
    """Fault that is on for a while."""

    name: str
    begins: float
    ends: float


@dataclass(kw_only=True)
class Result:
    """Result of one seed; `breaches` is empty if all went well."""

    seed: int
    faults: tuple[FaultPeriod, ...]
    ended: list[TaskChanged] = field(default_factory=list)
    breaches: list[str] = field(default_factory=list)


def drawn(seed: int, names: Sequence[str], during_s: float) -> tuple[FaultPeriod, ...]:
    """Two to six faults, each at a random time for a random while."""
    chance = Random(f"faults/{seed}")
    begins = [START_S + 3 + chance.random() * during_s for _ in range(2 + int(chance.random() * 5))]
    return tuple(
        FaultPeriod(
            name=names[int(chance.random() * len(names))], begins=at, ends=at + 0.1 + chance.random() * 6
        )
        for at in sorted(begins)
    )


def run(rig: Rig, seed: int, names: Sequence[str] = (), tasks: int = TASKS) -> Result:
    """Run one seed, from the start to the end of its last task; `names`: the faults to draw, default all."""
    faults = drawn(seed, names or tuple(rig.faults.known), tasks * rig.between_s)
    return World(rig, Result(seed=seed, faults=faults), tasks).run()


class World:
    """World of one seed: plant, driver and device; `result` grows while it runs."""

    def __init__(self, rig: Rig, result: Result, tasks: int) -> None:
        self.rig, self.result, self.now = rig, result, START_S
        self.disk = Disk()
        self._tasks = tasks
        (self._cell,) = rig.model.cells
        self._names = {robot.name for robot in rig.robots}
        self._others = {robot.name for robot in self._cell.robots} - self._names
        self._epoch = EPOCH
        self._start()
        self._places: list[Hashable] = []  # since a task began
        self._looked_at = self.now

    def _start(self) -> None:
        found = self.disk.found()
        self.plant = Plant(
            self.rig.model,
            epoch=self._epoch,
            now=self.now,
            memory=found.facts,
            kept=found.tasks.values(),
        )
        self._supervisor = Supervisor(
            [(self.rig.driver, self.rig.robots)],
            epoch=self._epoch,
            stale_after_s=self.rig.model.timing.stale_after_s,
        )
        self._driver: Loopback | None = None
        self._inbox: list[Event] = []
        self._for_driver: list[DriverOutput | CommandRequest | SendResult] = []

    def restart(self) -> None:
        """Kill the plant, its driver with it, and start it anew on what it has kept."""
        self._epoch += 1
        self._start()

    def submit(self, text: str) -> None:
        self._inbox.append(TaskRequest(at=self.now, text=text))

    def operate(self, verb: Verb) -> None:
        """Act on the cell as an operator."""
        self._inbox.append(OperatorRequest(at=self.now, verb=verb, scope=self._cell.name))

    def advance(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass; return True as soon as `until` comes true."""
        end = self.now + seconds
        while self.now < end and not until():
            self._pass_time()
        return until()

    def run(self) -> Result:
        times = [START_S + 1 + number * self.rig.between_s for number in range(self._tasks)]
        over_at = max([times[-1], *(each.ends for each in self.result.faults)]) + PATIENCE_S
        asked = 0
        while len(self.result.ended) < self._tasks and self.now < over_at:
            self._pass_time()
            if asked < self._tasks and self.now >= times[asked]:
                self.submit(self.rig.task(asked))
                asked += 1
        if (endless := self._tasks - len(self.result.ended)) > 0:
            self.result.breaches.append(f"hang: {endless} tasks have no end")
        told, given = self.rig.moves()
        if told > given:
            self.result.breaches.append(f"{told} moves were said, and only {given} were given")
        return self.result

    def _pass_time(self) -> None:
        """Go to the next deadline, and handle everything that follows."""
        due = [
            self.plant.next_deadline,
            self._supervisor.next_deadline or math.inf,
            self._looked_at + LOOKS_S,
        ]
        due += [self._driver.next_deadline] if self._driver else []
        self.now = max(self.now + 1e-4, min(due))
        self._switch_faults()
        if self._driver is not None:
            self._driver.pass_time(self.now)
        self._look_at_device()
        self._settle()
        if self.now >= self._looked_at + LOOKS_S:
            self._looked_at = self.now
            self._inbox += self.rig.bystanders(self.now)
            self._attend()

    def _switch_faults(self) -> None:
        for name in {each.name for each in self.result.faults}:
            drawn = (each for each in self.result.faults if each.name == name)
            self.rig.faults.switch(name, on=any(each.begins <= self.now < each.ends for each in drawn))

    def _settle(self) -> None:
        while True:
            events, self._for_driver = self._for_driver, []
            for message in self._supervisor.step(self.now, events):
                if isinstance(message, Report | Undelivered):
                    self._inbox.append(message)
                elif isinstance(message, Begin):
                    self._driver = self.rig.join(partial(self._hear, message.life), self.now)
                elif isinstance(message, Give):
                    self._give(message)
            inbox, self._inbox = self._inbox, []
            for out in self.plant.step(self.now, inbox):
                if not isinstance(out, Command | Heartbeat):
                    self.disk.commit(out, self.now)
                if isinstance(out, Command):
                    if out.robot in self._names:
                        self._for_driver.append(CommandRequest(at=self.now, command=out))
                elif isinstance(out, TaskChanged):
                    self._judge(out)
            if not self._for_driver and not self._inbox:
                return

    def _hear(self, life: Life, report: Report) -> None:
        self._for_driver.append(DriverOutput(at=self.now, life=life, report=report))

    def _give(self, give: Give) -> None:
        assert self._driver is not None
        why = self._driver.ask(give.command)
        error = None if why is None else OWN(text=why)
        self._for_driver.append(SendResult(at=self.now, life=give.life, command=give.command, error=error))

    def _attend(self) -> None:
        """Do as a person what the plant advises."""
        if self.rig.faults:
            return
        for advice in self.plant.advice(self._cell.name):
            if advice.refusal is not None or advice.scope in self._others:
                continue
            if isinstance(advice.do, Hand):
                self.rig.by_hand()
                if advice.do is Hand.REFERENCE and not self.rig.tells_homing:
                    continue  # the plant has to home it, which is the next advice
            else:
                if advice.do is Verb.HOME:
                    self.rig.before_home()
                request = OperatorRequest(
                    at=self.now, verb=advice.do, scope=advice.scope, by_hand=advice.by_hand
                )
                self._inbox.append(request)
            return

    # What must hold.

    def _look_at_device(self) -> None:
        place = self.rig.place()
        if place is not None and (not self._places or self._places[-1] != place):
            self._places.append(place)

    def _judge(self, change: TaskChanged) -> None:
        if change.state is TaskState.RUNNING:
            self._places = []
        if change.state not in ENDED:
            return
        self.result.ended.append(change)
        if change.state is TaskState.DONE and not _within(self.rig.work, self._places):
            self.result.breaches.append(f"false success: task {change.task}, it was seen at {self._places}")
        if change.state is TaskState.FAILED and change.reason not in self._possible():
            self.result.breaches.append(
                f"wrong cause: task {change.task} failed: {change.sentence} ({change.reason})"
            )

    def _possible(self) -> set[Reason]:
        near = [
            each.name
            for each in self.result.faults
            if each.begins <= self.now <= each.ends + self.rig.after_s
        ]
        return set().union(*(self.rig.causes[name] for name in near))


def _within(wanted: Sequence[Hashable], places: Sequence[Hashable]) -> bool:
    rest = iter(places)
    return all(each in rest for each in wanted)
