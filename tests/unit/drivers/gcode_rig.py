"""The driver of a machine with GRBL and a virtual one, under a clock that tests move."""

from __future__ import annotations

import itertools
from pathlib import Path

from arboleda.drivers.gcode.machine import Machine
from arboleda.drivers.gcode.settings import Settings
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import Report
from arboleda.plant_file.loader import load
from arboleda.virtual.faults import Faults
from arboleda.virtual.gcode.faults import FAULTS
from arboleda.virtual.gcode.machine import VirtualGrbl
from arboleda_driver_faults.stream_loopback import Loopback

EXAMPLE = Path(__file__).parents[3] / "examples/gantry/bench.yaml"
MODEL = load(EXAMPLE)
(GANTRY,) = MODEL.robots.values()
assert GANTRY.driver is not None and isinstance(GANTRY.driver.settings, Settings)
SETTINGS = GANTRY.driver.settings


class GrblRig:
    """Machine and controller, connected; `report` is the last that the plant would have."""

    def __init__(self, *on: str, homed: bool = True, **changes: object) -> None:
        self.faults = Faults(FAULTS, on)
        self.grbl = VirtualGrbl(self.faults, homed=homed)
        self.reports: list[Report] = []
        settings = Settings(**{**vars(SETTINGS), **changes})  # type: ignore[arg-type]
        self.line = Loopback(Machine([GANTRY], settings), self.grbl, self.reports.append, 100.0)
        self._numbers = itertools.count(1)
        self.wait(0.5)

    @property
    def report(self) -> Report:
        return self.reports[-1]

    @property
    def written(self) -> bytes:
        return b"".join(each for each in self.line.written if each != b"?")

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

    def move(self, *mm: float) -> str:
        return self.ask(MoveJoints(id=self._id(), robot=GANTRY.name, q=tuple(each / 1000 for each in mm)))

    def home(self) -> str:
        return self.ask(Home(id=self._id(), robot=GANTRY.name))

    def stop(self, mode: StopMode = StopMode.HALT) -> str:
        return self.ask(Stop(id=self._id(), robot=GANTRY.name, mode=mode))

    def ask(self, command: Command) -> str:
        assert self.line.ask(command) is None
        return command.id

    def _id(self) -> str:
        return f"7-{next(self._numbers)}"

    def _go_on(self, end: float) -> None:
        self.line.pass_time(min(max(self.line.next_deadline, self.line.now + 0.001), end))
