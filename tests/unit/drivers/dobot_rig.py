"""The driver's machine and a virtual Dobot, joined without sockets, under a clock that a test moves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from arboleda.drivers import MotionState, MoveJoints, Report
from arboleda.drivers.dobot.machine import (
    Answered,
    Asked,
    Close,
    Closed,
    Event,
    Fed,
    Machine,
    Message,
    Open,
    Opened,
    Say,
    Unsent,
)
from arboleda.drivers.dobot.settings import Settings
from arboleda.model.commands import Command
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing.plants import shipped
from arboleda.virtual.dobot.faults import FAULTS
from arboleda.virtual.dobot.machine import Answer, Frame, HangUp, Said, VirtualDobot
from arboleda.virtual.faults import Faults

START_S = 100.0
ARM = replace(shipped("sis_c").cells[0].arm, link=Link.DRIVER, evidence=Evidence.IDS)
GOAL = tuple(math.radians(each) for each in (10, 20, -30, 0, 5, 0))
GO = MoveJoints(id="9-1", robot=ARM.name, q=GOAL)


class Joined:
    """What one says the other hears at once; `reports` is all that the plant would hear."""

    def __init__(self, *on: str, enabled: bool = True, hear: Callable[[Report], None] | None = None) -> None:
        self.faults = Faults(FAULTS, on)
        self.dobot = VirtualDobot(self.faults, enabled=enabled, unix_s=1_700_000_000.0)
        self.driver = Machine(ARM, Settings(host="dobot"))
        self.now = START_S
        self.told: list[str] = []  # lines of the dashboard
        self.reports: list[Report] = []
        self._hear = hear or self.reports.append
        self._client = 0  # grows with each connection; 0: there is none
        self._connected = False

    @property
    def last(self) -> Report:
        return self.reports[-1]

    @property
    def next_deadline(self) -> float:
        return max(self.now, min(self.dobot.next_deadline, self.driver.next_deadline))

    def ask(self, command: Command) -> str | None:
        """Command the arm; why it could not leave, or None."""
        unsent = [each for each in self._step_driver(Asked(command=command)) if isinstance(each, Unsent)]
        return unsent[0].why if unsent else None

    def tell(self, line: str) -> None:
        """What another client of the dashboard says."""
        self.dobot.step(self.now, [Said(client=-1, text=line)])

    def wait(self, s: float, until: Callable[[Report], bool] | None = None) -> None:
        """Let so much time pass, or less, up to a report."""
        end = self.now + s
        while self.now < end:
            self.now = min(end, max(self.next_deadline, self.now + 1e-4))
            self.pass_time()
            if until is not None and self.reports and until(self.last):
                return

    def pass_time(self) -> None:
        self._step_dobot()
        self._step_driver()

    def _step_driver(self, *events: Event) -> list[Message]:
        out = self.driver.step(self.now, events)
        for message in out:
            self._do(message)
        return out

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Open):
            off = self.dobot.is_off
            self._connected = not off
            self._client += 1
            self._step_driver(Closed(why="refused") if off else Opened())
        elif isinstance(message, Close):
            self._connected = False
        elif isinstance(message, Say) and self._connected:
            self.told.append(message.text)
            self._step_dobot(Said(client=self._client, text=message.text))

    def _step_dobot(self, *said: Said) -> None:
        for message in self.dobot.step(self.now, said):
            if not self._connected:
                continue
            if isinstance(message, HangUp):
                self._connected = False
                self._step_driver(Closed(why="hung up"))
            elif isinstance(message, Frame):
                self._step_driver(Fed(data=message.data))
            elif isinstance(message, Answer) and message.client == self._client:
                self._step_driver(Answered(data=message.text.encode()))


def stopped(report: Report) -> bool:
    return report.state is MotionState.STOPPED
