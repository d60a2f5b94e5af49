"""A plant with a Dobot, seed by seed: the shipped core, supervisor and driver, the virtual arm, its faults.

Everything is in one process under a clock that is moved from deadline to deadline, a minute in a second.
What the plant says of a task is held against where the virtual arm was, and with what output.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from random import Random

from arboleda.core.advice import Hand
from arboleda.core.plant import Plant
from arboleda.drivers.supervisor import Asked, Begin, Give, Life, Said, Supervisor, Taken
from arboleda.kinds.arm import MoveJoints
from arboleda.model.commands import Command
from arboleda.model.messages import (
    ENDED,
    Event,
    OperatorRequest,
    Reason,
    Report,
    TaskChanged,
    TaskRequest,
    TaskState,
    Undelivered,
)
from arboleda.model.plant_model import Evidence, Link, MotionState, PlantModel
from arboleda.model.sentence import OWN
from arboleda.recipes.storage_cell import StorageCell

from ..faults import Faults
from .faults import FAULTS
from .joined import Joined
from .machine import VirtualDobot

START_S, EPOCH = 100.0, 7
FRAME_S = 0.04  # a fifth of a real one's frames is enough to see every state
TASKS, BETWEEN_S = 4, 8.0
LOOKS_S = 1.0  # how often somebody looks what the plant advises
PATIENCE_S = 240.0  # after the last fault, for the last task
AFTER_S = 20.0  # so long a fault may be the cause of what fails: the longest deadline of a move is shorter
NEAR_DEG = 0.02

NO_WORK = {Reason.DEVICE_FAULT, Reason.REJECTED, Reason.NOT_HOMED}
NO_LINK = {Reason.LINK_LOST}
CAUSES: dict[str, set[Reason]] = {
    "stop_button": NO_WORK,
    "collision": NO_WORK,
    "alarm": NO_WORK,
    "power_off": NO_WORK,
    "power_cycle": {Reason.LINK_LOST, Reason.REBOOTED, *NO_WORK},
    "script": {Reason.REJECTED, Reason.DEADLINE, Reason.DEVICE_FAULT},
    "not_tcp": {Reason.REJECTED, Reason.STOP_UNCONFIRMED},
    "second_client": {Reason.DEVICE_FAULT, Reason.REJECTED},
    "refuse": {Reason.REJECTED},
    "no_replies": NO_LINK,
    "late_replies": NO_LINK,
    "nonsense_replies": NO_LINK,
    "wrong_number": {Reason.DEVICE_FAULT},
    "hang_up": NO_LINK,
    "mute": NO_LINK,
    "frozen": NO_LINK,
    "garbled": NO_LINK,
    "torn": NO_LINK,
    "late_start": set(),
    "lie": {Reason.NOT_REACHED},
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE},
    "deaf": {Reason.STOP_UNCONFIRMED},
    "stuck_output": {Reason.REJECTED},
    "slow": {Reason.DEADLINE},
}
"""Why a task may fail while a fault is there, or soon after it."""


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A fault that is on for a while."""

    name: str
    begins: float
    ends: float


@dataclass(kw_only=True)
class Result:
    """What came of a seed; `breaches` is empty where all was well."""

    seed: int
    faults: tuple[Drawn, ...]
    ended: list[TaskChanged] = field(default_factory=list)
    breaches: list[str] = field(default_factory=list)


def plant_of(shipped: PlantModel) -> PlantModel:
    """The cell of the shipped plant whose arm is a Dobot, reached by a driver."""
    cell = next(each for each in shipped.cells if isinstance(each, StorageCell) and len(each.arm.joints) == 6)
    arm = replace(cell.arm, link=Link.DRIVER, evidence=Evidence.IDS)
    return replace(shipped, cells=(replace(cell, arm=arm),))


def drawn(seed: int, names: Sequence[str]) -> tuple[Drawn, ...]:
    """Two to six faults, each at a random time for a random while."""
    chance = Random(f"faults/{seed}")
    begins = [START_S + 3 + chance.random() * TASKS * BETWEEN_S for _ in range(2 + int(chance.random() * 5))]
    return tuple(
        Drawn(name=names[int(chance.random() * len(names))], begins=at, ends=at + 0.1 + chance.random() * 6)
        for at in sorted(begins)
    )


def run(model: PlantModel, seed: int, names: Sequence[str] = tuple(FAULTS)) -> Result:
    """One seed, from the start to the end of its last task."""
    return World(model, Result(seed=seed, faults=drawn(seed, names))).run()


class World:
    """The plant, its driver and the arm; `result` grows while it runs."""

    def __init__(self, model: PlantModel, result: Result) -> None:
        (cell,) = model.cells
        assert isinstance(cell, StorageCell)
        self.cell, self.result, self.now = cell, result, START_S
        self.faults = Faults(FAULTS)
        self.dobot = VirtualDobot(self.faults, enabled=True, frame_s=FRAME_S)
        self.plant = Plant(model, epoch=EPOCH, now=self.now)
        stale_s = model.timing.stale_after_s
        self._supervisor = Supervisor([("dobot", [cell.arm])], epoch=EPOCH, stale_after_s=stale_s)
        self._driver: Joined | None = None
        self._inbox: list[Event] = []
        self._heard: list[Said | Asked | Taken] = []
        self._moves = 0  # that were given to the driver
        spots = {"home": cell.home, "pick": cell.palletizing.pick, "place": cell.palletizing.place}
        self._spots = {name: _degrees(pose.joints) for name, pose in spots.items()}
        self._seen: list[tuple[str, bool]] = []  # where the arm stood, with its output, since a task began
        self._looked_at = self.now

    def run(self) -> Result:
        times = [START_S + 1 + number * BETWEEN_S for number in range(TASKS)]
        over_at = max([times[-1], *(each.ends for each in self.result.faults)]) + PATIENCE_S
        asked = 0
        while len(self.result.ended) < TASKS and self.now < over_at:
            self._pass_time()
            if asked < TASKS and self.now >= times[asked]:
                text = f"{self.cell.name} palletizing #{asked}"
                self._inbox.append(TaskRequest(at=self.now, text=text))
                asked += 1
        if len(self.result.ended) < TASKS:
            self.result.breaches.append(f"hang: {TASKS - len(self.result.ended)} tasks have no end")
        self._judge_moves()
        return self.result

    def _pass_time(self) -> None:
        """Up to the next deadline, and all that follows from it."""
        due = [
            self.plant.next_deadline,
            self._supervisor.next_deadline or math.inf,
            self._looked_at + LOOKS_S,
        ]
        due += [self._driver.next_deadline] if self._driver else []
        self.now = max(self.now + 1e-4, min(due))
        self._switch_faults()
        if self._driver is not None:
            self._driver.now = self.now
            self._driver.pass_time()
        self._look_at_arm()
        self._settle()
        if self.now >= self._looked_at + LOOKS_S:
            self._looked_at = self.now
            self._inbox.append(self._said_by_mobile())
            self._attend()

    def _switch_faults(self) -> None:
        for name in {each.name for each in self.result.faults}:
            drawn = (each for each in self.result.faults if each.name == name)
            self.faults.switch(name, on=any(each.begins <= self.now < each.ends for each in drawn))

    def _settle(self) -> None:
        while True:
            heard, self._heard = self._heard, []
            for message in self._supervisor.step(self.now, heard):
                if isinstance(message, Report | Undelivered):
                    self._inbox.append(message)
                elif isinstance(message, Begin):
                    self._driver = Joined(
                        self.cell.arm, self.dobot, partial(self._hear, message.life), self.now
                    )
                elif isinstance(message, Give):
                    self._give(message)
            inbox, self._inbox = self._inbox, []
            for out in self.plant.step(self.now, inbox):
                if isinstance(out, Command):
                    if out.robot == self.cell.arm.name:
                        self._heard.append(Asked(at=self.now, command=out))
                elif isinstance(out, TaskChanged):
                    self._judge(out)
            if not self._heard and not self._inbox:
                return

    def _hear(self, life: Life, report: Report) -> None:
        self._heard.append(Said(at=self.now, life=life, report=report))

    def _give(self, give: Give) -> None:
        assert self._driver is not None
        self._moves += isinstance(give.command, MoveJoints)
        why = self._driver.ask(give.command)
        error = None if why is None else OWN(text=why)
        self._heard.append(Taken(at=self.now, life=give.life, command=give.command, error=error))

    def _said_by_mobile(self) -> Report:
        """It has no part in this, stands still and is heard."""
        name, still = self.cell.mobile.name, MotionState.STOPPED
        return Report(
            at=self.now, robot=name, epoch=EPOCH, plant=EPOCH, boot_id=1, state=still, node=0, homed=True
        )

    # Somebody who does what is advised.

    def _attend(self) -> None:
        if self.faults:
            return
        for advice in self.plant.advice(self.cell.name):
            if advice.refusal is not None or advice.scope == self.cell.mobile.name:
                continue
            if isinstance(advice.do, Hand):
                self._at_the_robot()
            else:
                request = OperatorRequest(
                    at=self.now, verb=advice.do, scope=advice.scope, by_hand=advice.by_hand
                )
                self._inbox.append(request)
            return

    def _at_the_robot(self) -> None:
        """Alarms are cleared and the arm is enabled at its pendant."""
        assert self._driver is not None
        for line in ("ClearError()", "PowerOn()", "EnableRobot()"):
            self._driver.tell(line)

    # What must hold.

    def _look_at_arm(self) -> None:
        for name, spot in self._spots.items():
            if all(abs(a - b) < NEAR_DEG for a, b in zip(self.dobot.joints_deg, spot, strict=True)):
                seen = (name, bool(self.dobot.outputs & 1))
                if not self._seen or self._seen[-1] != seen:
                    self._seen.append(seen)

    def _judge(self, change: TaskChanged) -> None:
        if change.state is TaskState.RUNNING:
            self._seen = []
        if change.state not in ENDED:
            return
        self.result.ended.append(change)
        if change.state is TaskState.DONE and not _within(WORK, self._seen):
            self.result.breaches.append(f"false success: task {change.task}, the arm was at {self._seen}")
        if change.state is TaskState.FAILED and change.reason not in self._possible():
            self.result.breaches.append(
                f"wrong cause: task {change.task} failed: {change.sentence} ({change.reason})"
            )

    def _possible(self) -> set[Reason]:
        near = [each.name for each in self.result.faults if each.begins <= self.now <= each.ends + AFTER_S]
        return set().union(*(CAUSES[name] for name in near))

    def _judge_moves(self) -> None:
        said = sum(line.startswith("MovJ") for line in self._driver.told) if self._driver else 0
        if said > self._moves:
            self.result.breaches.append(f"{said} moves were said, and only {self._moves} were given")


WORK = [("pick", True), ("place", True), ("place", False)]
"""Where the arm has to have been, with its output, in this order."""


def _within(wanted: Sequence[tuple[str, bool]], seen: Sequence[tuple[str, bool]]) -> bool:
    rest = iter(seen)
    return all(each in rest for each in wanted)


def _degrees(joints: Sequence[float]) -> tuple[float, ...]:
    return tuple(math.degrees(each) for each in joints)
