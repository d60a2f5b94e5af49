"""The driver of machines of axes and virtual ones, under a clock that tests move."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import replace

from tests.packages import ROOT

from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda.plant_file.loader import load
from arboleda_drivers.gcode.dialects import machine
from arboleda_drivers.gcode.settings import Settings
from arboleda_drivers.gcode.virtual.faults import GRBL_FAULTS, MARLIN_FAULTS, MOONRAKER_FAULTS
from arboleda_drivers.gcode.virtual.grbl import BANNER, VirtualGrbl
from arboleda_drivers.gcode.virtual.marlin import VirtualMarlin
from arboleda_drivers.gcode.virtual.moonraker import VirtualMoonraker
from arboleda_drivers.virtual.faults import Faults

from ..connections.stream_rig import StreamRig

EXAMPLES = ROOT / "examples/gantry"


def gantry(file: str) -> tuple[Robot, Settings]:
    """The gantry of an example, and the settings of its driver."""
    (robot,) = load(EXAMPLES / file).robots.values()
    assert robot.driver is not None and isinstance(robot.driver.settings, Settings)
    return robot, robot.driver.settings


class GcodeRig(StreamRig):
    """Machine of the driver and a virtual machine of axes."""

    example = "bench.yaml"
    known: Mapping[str, str] = GRBL_FAULTS

    def __init__(self, *on: str, **changes: object) -> None:
        self.faults = Faults(self.known, on)
        robot, settings = gantry(self.example)
        settings = Settings(**{**vars(settings), **changes})  # type: ignore[arg-type]
        if not settings.homing:
            robot = replace(robot, home_at_start=False)
        super().__init__(robot, machine([robot], settings), self.controller())

    @abstractmethod
    def controller(self) -> VirtualGrbl | VirtualMarlin | VirtualMoonraker:
        """The virtual machine at the other end."""

    @property
    def written(self) -> bytes:
        return b"".join(each for each in self.line.written if each != b"?")

    def move(self, *mm: float) -> str:
        return self.ask(MoveJoints(id=self.id(), robot=self.robot.name, q=tuple(each / 1000 for each in mm)))


class GrblRig(GcodeRig):
    """Machine with GRBL, greeting with `banner`; `homed`: it was homed before; `locks`: its homing is on."""

    def __init__(
        self, *on: str, homed: bool = True, locks: bool = True, banner: str = BANNER, **changes: object
    ) -> None:
        self._homed, self._locks, self._banner = homed, locks, banner
        super().__init__(*on, **changes)

    def controller(self) -> VirtualGrbl:
        self.grbl = VirtualGrbl(self.faults, homed=self._homed)
        self.grbl.banner = self._banner
        self.grbl.step(0.0, b"$22=1\n" if self._locks else b"$22=0\n")
        return self.grbl

    def says(self, line: str) -> None:
        """Have it say a line."""
        self.line.hear(line.encode("ascii") + b"\r\n")

    def again(self, fault: str) -> Report:
        """Have a fault come and go, and wait for what the plant hears after it."""
        before = len(self.reports)
        self.faults.switch(fault, on=True)
        self.wait(0.5)
        self.faults.switch(fault, on=False)
        self.wait(3.0)
        assert len(self.reports) > before
        return self.report


class MarlinRig(GcodeRig):
    """Machine with Marlin; `homed`: the plant has homed it."""

    example = "marlin.yaml"
    known = MARLIN_FAULTS

    def __init__(self, *on: str, homed: bool = True, **changes: object) -> None:
        super().__init__(*on, **changes)
        if homed:
            self.until(done=self.home(), homed=True)

    def controller(self) -> VirtualMarlin:
        self.marlin = VirtualMarlin(self.faults)
        return self.marlin


class MoonrakerRig(GcodeRig):
    """Machine with Klipper behind Moonraker; `homed`: the plant has homed it."""

    example = "moonraker.yaml"
    known = MOONRAKER_FAULTS

    def __init__(self, *on: str, homed: bool = True, **changes: object) -> None:
        super().__init__(*on, **changes)
        if homed:
            self.until(done=self.home(), homed=True)

    def controller(self) -> VirtualMoonraker:
        self.moonraker = VirtualMoonraker(self.faults)
        return self.moonraker

    @property
    def pieces(self) -> list[str]:
        """The lines of moves that were sent."""
        requests = map(json.loads, self.written.splitlines())
        scripts = [each["params"].get("script", "") for each in requests]
        return [line for script in scripts for line in script.split("\n") if line.startswith("G1")]
