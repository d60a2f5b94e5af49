"""Campaign of the example's gantry with GRBL under faults: it goes to two spots, and home."""

from __future__ import annotations

import re
from collections.abc import Sequence

from arboleda.drivers.gcode.machine import Machine
from arboleda.drivers.gcode.settings import Settings
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda.virtual.gcode.faults import FAULTS
from arboleda.virtual.gcode.machine import VirtualGrbl

from .rig import Causes, Hear, Rig
from .stream_loopback import Loopback

NEAR_MM = 0.05
MOVE = re.compile(rb"G53G1")

NO_WORK = {Reason.DEVICE_FAULT, Reason.REJECTED, Reason.NOT_HOMED}
NO_LINK = {Reason.LINK_LOST}
CAUSES: Causes = {
    "hard_limit": NO_WORK,
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


class GantryRig(Rig):
    """Test with a gantry that goes round; it sees where the machine truly is."""

    driver = "gcode"
    causes = CAUSES
    work = ("rack", "drill", "home")
    between_s = 40.0
    after_s = 40.0

    def __init__(self, example: PlantModel) -> None:
        super().__init__(FAULTS)
        self.model = example
        (self._gantry,) = example.robots.values()
        assert self._gantry.driver is not None and isinstance(self._gantry.driver.settings, Settings)
        self._settings = self._gantry.driver.settings
        self._grbl = VirtualGrbl(self.faults, homed=True)
        self._driver: Loopback | None = None
        (cell,) = example.cells
        self._spots = {name: pose.joints for name, pose in cell.reach[self._gantry.name].targets.items()}

    @property
    def robots(self) -> Sequence[Robot]:
        return [self._gantry]

    def task(self, number: int) -> str:
        return f"bench visit rack drill #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = Loopback(Machine([self._gantry], self._settings), self._grbl, hear, now)
        return self._driver

    def place(self) -> str | None:
        here = self._settings.joints(self._grbl.place)
        for name, spot in self._spots.items():
            if all(abs(a - b) * 1000 < NEAR_MM for a, b in zip(here, spot, strict=True)):
                return name
        return None

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        return (len(MOVE.findall(b"".join(self._driver.written))), self._driver.given)
