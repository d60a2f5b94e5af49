"""A driver and a virtual device at one stream of bytes, under a clock that tests move."""

from __future__ import annotations

import itertools
from abc import ABC, abstractmethod

from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda_driver_faults.stream_loopback import Loopback
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.virtual.pty_line import LineMachine


class StreamRig(ABC):
    """Machine and device, connected; `report` is the last that the plant would have."""

    def __init__(self, robot: Robot, driver: ControllerMachine, far: LineMachine) -> None:
        self.robot = robot
        self.reports: list[Report] = []
        self.line = Loopback(driver, far, self.reports.append, 100.0)
        self._numbers = itertools.count(1)
        self.wait(0.5)

    @property
    def report(self) -> Report:
        return self.reports[-1]

    def wait(self, seconds: float) -> None:
        end = self.line.now + seconds
        while self.line.now < end:
            self._go_on(end)

    def until(self, at_most_s: float = 30.0, **fields: object) -> Report:
        """Let time pass until a report has these values."""
        end = self.line.now + at_most_s
        while self.line.now < end:
            if self.reports and all(getattr(self.report, name) == value for name, value in fields.items()):
                return self.report
            self._go_on(end)
        raise AssertionError(f"no report with {fields}; the last one is {self.reports[-1:]}")

    def told(self, name: str, at_most_s: float = 30.0) -> str:
        """The word that comes with the next report of this field."""
        end, before = self.line.now + at_most_s, len(self.reports)
        while self.line.now < end:
            for report in self.reports[before:]:
                if getattr(report, name) is not None:
                    return str(getattr(report, name))
            self._go_on(end)
        raise AssertionError(f"no {name}; the last report is {self.report}")

    @abstractmethod
    def move(self, *values: float) -> str:
        """Have it move to these places of its axes or joints."""

    def home(self) -> str:
        return self.ask(Home(id=self.id(), robot=self.robot.name))

    def stop(self, mode: StopMode = StopMode.HALT) -> str:
        return self.ask(Stop(id=self.id(), robot=self.robot.name, mode=mode))

    def ask(self, command: Command) -> str:
        assert self.line.ask(command) is None
        return command.id

    def id(self) -> str:
        """The id of the next command."""
        return f"7-{next(self._numbers)}"

    def _go_on(self, end: float) -> None:
        self.line.pass_time(min(max(self.line.next_deadline, self.line.now + 0.001), end))
