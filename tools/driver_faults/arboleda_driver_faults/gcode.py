"""Campaigns of the example's gantries with GRBL, Marlin and Klipper under faults: two spots, and home."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.gcode.dialects import machine
from arboleda_drivers.gcode.settings import MM, Settings
from arboleda_drivers.gcode.virtual.faults import GRBL_FAULTS, MARLIN_FAULTS, MOONRAKER_FAULTS
from arboleda_drivers.gcode.virtual.grbl import VirtualGrbl
from arboleda_drivers.gcode.virtual.marlin import VirtualMarlin
from arboleda_drivers.gcode.virtual.moonraker import VirtualMoonraker

from .rig import Causes, Hear, Rig
from .stream_loopback import Loopback

NEAR_MM = 0.05
MOVE = re.compile(rb"G1X")

NO_WORK = {Reason.DEVICE_FAULT, Reason.REJECTED, Reason.NOT_HOMED}
NO_LINK = {Reason.LINK_LOST}
GRBL_CAUSES: Causes = {
    "hard_limit": NO_WORK,
    "soft_limit": NO_WORK,
    "door": {Reason.STOP_UNCONFIRMED, *NO_WORK},
    "hold_pressed": NO_WORK,
    "boot": {Reason.REBOOTED, *NO_LINK, *NO_WORK},
    "unplugged": NO_LINK,
    "mute": NO_LINK,
    "no_ok": NO_LINK,
    "error": {Reason.REJECTED},
    "torn": NO_LINK,
    "noise": set(),
    "garbled": NO_LINK,
    "no_position": NO_LINK,
    "late_start": set(),
    "lie": {Reason.NOT_REACHED},
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE},
    "deaf": {Reason.STOP_UNCONFIRMED},
    "no_reset": {Reason.STOP_UNCONFIRMED},
    "slow": {Reason.DEADLINE},
    "homing_fails": {Reason.DEVICE_FAULT, Reason.NOT_HOMED},
    "second_client": {Reason.NOT_REACHED, *NO_WORK},
    "asleep": {Reason.STOP_UNCONFIRMED, *NO_WORK},
}


MARLIN_CAUSES: Causes = {
    "endstop_hit": NO_WORK,
    "boot": {Reason.REBOOTED, *NO_LINK, *NO_WORK},
    "killed": {*NO_LINK, *NO_WORK},
    "stopped": NO_WORK,
    "unplugged": {*NO_LINK, *NO_WORK},
    "mute": {*NO_LINK, *NO_WORK},
    "no_ok": {*NO_LINK, *NO_WORK},
    "unknown": NO_WORK,
    "motors_off": NO_WORK,
    "torn": {*NO_LINK, *NO_WORK},
    "noise": set(),
    "garbled": {*NO_LINK, *NO_WORK},
    "mistaken": {*NO_LINK, *NO_WORK},
    "lie": {Reason.NOT_REACHED},
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE, *NO_WORK},
    "deaf": {Reason.STOP_UNCONFIRMED, *NO_WORK},
    "no_parser": {*NO_LINK, *NO_WORK},
    "no_keepalive": {*NO_LINK, *NO_WORK},
    "slips": set(),
    "slow": {Reason.DEADLINE, *NO_WORK},
    "homing_fails": NO_WORK,
    "second_client": {Reason.NOT_REACHED, *NO_WORK},
}


MOONRAKER_CAUSES: Causes = {
    "shutdown": NO_WORK,
    "error": NO_WORK,
    "boot": {Reason.REBOOTED, *NO_LINK, *NO_WORK},
    "unplugged": NO_LINK,
    "mute": NO_LINK,
    "no_key": NO_LINK,
    "no_ok": {Reason.DEADLINE, *NO_WORK},
    "refuses": NO_WORK,
    "motors_off": NO_WORK,
    "busy_elsewhere": {Reason.DEADLINE, *NO_WORK},
    "second_client": {Reason.NOT_REACHED, *NO_WORK},
    "offset": NO_WORK,  # set under way, it leads elsewhere
    "torn": {*NO_LINK, *NO_WORK},
    "noise": set(),
    "garbled": NO_LINK,
    "no_position": NO_LINK,
    "lie": {Reason.NOT_REACHED},
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE, *NO_WORK},
    "slow": {Reason.DEADLINE, *NO_WORK},
    "deaf": {Reason.STOP_UNCONFIRMED},
    "homing_fails": NO_WORK,
}


class GantryRig(Rig):
    """Test with a gantry that goes round; it sees where the machine truly is."""

    driver = "gcode"
    causes = GRBL_CAUSES
    known: Mapping[str, str] = GRBL_FAULTS
    work = ("rack", "drill", "home")
    between_s = 40.0
    after_s = 40.0

    def __init__(self, example: PlantModel) -> None:
        super().__init__(self.known)
        self.model = example
        (self._gantry,) = example.robots.values()
        assert self._gantry.driver is not None and isinstance(self._gantry.driver.settings, Settings)
        self._settings = self._gantry.driver.settings
        self._virtual = self._controller()
        self._driver: Loopback | None = None
        (cell,) = example.cells
        self._spots = {name: pose.joints for name, pose in cell.reach[self._gantry.name].targets.items()}

    def _controller(self) -> VirtualGrbl | VirtualMarlin | VirtualMoonraker:
        return VirtualGrbl(self.faults, homed=True)

    @property
    def robots(self) -> Sequence[Robot]:
        return [self._gantry]

    def task(self, number: int) -> str:
        return f"bench visit rack drill #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = Loopback(machine([self._gantry], self._settings), self._virtual, hear, now)
        return self._driver

    @property
    def where(self) -> tuple[float, ...]:
        return tuple(self._virtual.place)

    def place(self) -> str | None:
        here = self._settings.joints(self._virtual.place)
        for name, spot in self._spots.items():
            if all(abs(a - b) * 1000 < NEAR_MM for a, b in zip(here, spot, strict=True)):
                return name
        return None

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        return (len(MOVE.findall(b"".join(self._driver.written))), self._driver.given)


def _without_switches(example: PlantModel) -> PlantModel:
    """The example with a gantry that only a person can say to stand at its zero."""

    def limp(robot: Robot) -> Robot:
        assert robot.driver is not None and isinstance(robot.driver.settings, Settings)
        settings = replace(robot.driver.settings, homing=False)
        driver = replace(robot.driver, settings=settings, home_moves=False, home_is_claim=True)
        return replace(robot, driver=driver, home_at_start=False)

    return replace(example, cells=tuple(cell.with_robots(limp) for cell in example.cells))


class LimpRig(GantryRig):
    """Test with a gantry without switches, which does not lock itself when it boots."""

    tells_homing = False  # only its person knows

    def __init__(self, example: PlantModel) -> None:
        super().__init__(_without_switches(example))

    def _controller(self) -> VirtualGrbl:
        self._grbl = VirtualGrbl(self.faults, homed=True)
        self._grbl.step(0.0, b"$22=0\n")
        return self._grbl

    def before_home(self) -> None:
        self._grbl.begin_at_zero()


class MoonrakerRig(GantryRig):
    """Test with a gantry that is told its moves in pieces, of which the last one leads to the spot."""

    causes = MOONRAKER_CAUSES
    known = MOONRAKER_FAULTS
    tells_homing = False  # nobody homes it at its own page here

    def _controller(self) -> VirtualMoonraker:
        self._moonraker = VirtualMoonraker(self.faults)
        return self._moonraker

    def by_hand(self) -> None:
        """Restart its firmware, where that is what it waits for."""
        if self._moonraker.needs_reset:
            self._moonraker.press_reset()

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        said = b"".join(self._driver.written)
        ends = (
            "".join(f"{a}{at * MM:.4f}" for a, at in zip("XYZ", q, strict=True)) for q in self._spots.values()
        )
        return (sum(said.count(b"G1" + end.encode("ascii")) for end in ends), self._driver.given)


class MarlinRig(GantryRig):
    """Test with a gantry that counts its steps, and is elsewhere once it has lost some."""

    causes = MARLIN_CAUSES
    known = MARLIN_FAULTS
    tells_homing = False

    def _controller(self) -> VirtualMarlin:
        self._marlin = VirtualMarlin(self.faults)
        return self._marlin

    def by_hand(self) -> None:
        """Press the button on its board, where that is what it waits for."""
        if self._marlin.needs_reset:
            self._marlin.press_reset()


class LimpMarlinRig(MarlinRig):
    """Test with a gantry with Marlin without switches."""

    def __init__(self, example: PlantModel) -> None:
        super().__init__(_without_switches(example))

    def before_home(self) -> None:
        self._marlin.push_to_zero()
