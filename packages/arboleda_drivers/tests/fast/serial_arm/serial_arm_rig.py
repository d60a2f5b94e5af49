"""The driver of an arm of servos and a virtual one, under a clock that tests move."""

from __future__ import annotations

import itertools
import math

from tests.packages import ROOT

from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import MotionState, Report
from arboleda.plant_file.loader import load
from arboleda_driver_faults.stream_loopback import Loopback
from arboleda_drivers.serial_arm.machine import Machine
from arboleda_drivers.serial_arm.settings import Settings
from arboleda_drivers.serial_arm.virtual.faults import FAULTS
from arboleda_drivers.serial_arm.virtual.machine import VirtualServos
from arboleda_drivers.virtual.faults import Faults

EXAMPLE = ROOT / "examples/serial_arm/desk.yaml"
MODEL = load(EXAMPLE)
(ARM,) = (robot for robot in MODEL.robots.values() if isinstance(robot, Arm))
assert ARM.driver is not None and isinstance(ARM.driver.settings, Settings)
SETTINGS = ARM.driver.settings
POLL_S = 0.05  # what is fewer rounds than a real one's shows all that matters


def settings(**changes: object) -> Settings:
    return Settings(**{**vars(SETTINGS), **changes})  # type: ignore[arg-type]


class ServoRig:
    """Machine and servos, connected; `report` is the last that the plant would have."""

    def __init__(self, maker: str = "feetech", *on: str, torque: bool = True, **changes: object) -> None:
        self.faults = Faults(FAULTS, on)
        self.servos = VirtualServos(self.faults, maker=maker, torque=torque)
        self.reports: list[Report] = []
        machine = Machine([ARM], settings(protocol=maker, poll_s=POLL_S, speed_percent=60, **changes))
        self.line = Loopback(machine, self.servos, self.reports.append, 100.0)
        self._numbers = itertools.count(1)
        self.wait(0.5)

    @property
    def report(self) -> Report:
        return self.reports[-1]

    def wait(self, seconds: float) -> None:
        end = self.line.now + seconds
        while self.line.now < end:
            self._go_on(end)

    def until(self, at_most_s: float = 20.0, **fields: object) -> Report:
        """Let time pass until a report has these values."""
        end = self.line.now + at_most_s
        while self.line.now < end:
            if any(self._fits(each, fields) for each in self.reports[-1:]):
                return self.report
            self._go_on(end)
        raise AssertionError(f"no report with {fields}; the last one is {self.report}")

    def told(self, name: str, at_most_s: float = 20.0) -> str:
        """The word that comes with the next report of this field."""
        end, before = self.line.now + at_most_s, len(self.reports)
        while self.line.now < end:
            for report in self.reports[before:]:
                if getattr(report, name) is not None:
                    return str(getattr(report, name))
            self._go_on(end)
        raise AssertionError(f"no {name}; the last report is {self.report}")

    def move(self, *degrees: float) -> str:
        return self.ask(MoveJoints(id=self._id(), robot=ARM.name, q=tuple(map(math.radians, degrees))))

    def grip(self, *, on: bool) -> str:
        return self.ask(SetEffector(id=self._id(), robot=ARM.name, on=on))

    def home(self) -> str:
        return self.ask(Home(id=self._id(), robot=ARM.name))

    def stop(self, mode: StopMode = StopMode.HALT) -> str:
        return self.ask(Stop(id=self._id(), robot=ARM.name, mode=mode))

    def ask(self, command: Command) -> str:
        assert self.line.ask(command) is None
        return command.id

    def _id(self) -> str:
        return f"7-{next(self._numbers)}"

    def _go_on(self, end: float) -> None:
        self.line.pass_time(min(max(self.line.next_deadline, self.line.now + 0.001), end))

    @staticmethod
    def _fits(report: Report, fields: dict[str, object]) -> bool:
        return all(getattr(report, name) == value for name, value in fields.items())


STILL = MotionState.STOPPED
