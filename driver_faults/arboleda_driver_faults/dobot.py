"""Campaign of a plant with a Dobot under its faults: the task, and the failures that each may cause."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command
from arboleda.model.messages import Reason, Report
from arboleda.model.plant_model import Evidence, Link, MotionState, PlantModel, Robot
from arboleda.recipes.storage_layout import StorageLayout
from arboleda.virtual.dobot.faults import FAULTS
from arboleda.virtual.dobot.machine import VirtualDobot

from .dobot_loopback import Loopback
from .rig import EPOCH, Hear, Rig

FRAME_S = 0.04  # a fifth of a real one's frames is enough to see every state
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


def plant_of(shipped: PlantModel) -> PlantModel:
    """The shipped plant's cell whose arm is a Dobot behind a driver."""
    layouts = [StorageLayout(cell) for cell in shipped.cells if cell.handover]
    layout = next(each for each in layouts if len(each.arm.joints) == 6)

    def driven(robot: Robot) -> Robot:
        is_arm = robot.name == layout.arm.name
        return replace(robot, link=Link.DRIVER, evidence=Evidence.IDS) if is_arm else robot

    return replace(shipped, cells=(layout.cell.with_robots(driven),))


class DobotRig(Rig):
    """Test with parts that go from the pick to the place; it sees the arm's place and its output."""

    driver = "dobot"
    causes = CAUSES
    work = (("pick", True), ("place", True), ("place", False))

    def __init__(self, shipped: PlantModel) -> None:
        super().__init__(FAULTS)
        self.model = plant_of(shipped)
        (cell,) = self.model.cells
        self._layout = StorageLayout(cell)
        self._dobot = VirtualDobot(self.faults, enabled=True, frame_s=FRAME_S)
        self._driver: MoveCounter | None = None
        spots = {
            "home": self._layout.home,
            "pick": self._layout.palletizing.pick,
            "place": self._layout.palletizing.place,
        }
        self._spots = {name: _degrees(pose.joints) for name, pose in spots.items()}

    @property
    def robots(self) -> Sequence[Robot]:
        return [self._layout.arm]

    def task(self, number: int) -> str:
        return f"{self._layout.name} palletizing #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = MoveCounter(self._layout.arm, self._dobot, hear, now)
        return self._driver

    def seen(self) -> tuple[str, bool] | None:
        for name, spot in self._spots.items():
            if all(abs(a - b) < NEAR_DEG for a, b in zip(self._dobot.joints_deg, spot, strict=True)):
                return (name, bool(self._dobot.outputs & 1))
        return None

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        return (sum(line.startswith("MovJ") for line in self._driver.told), self._driver.given)

    def bystanders(self, now: float) -> list[Report]:
        """The reports of the mobile robot, which stands still."""
        name, still = self._layout.mobile.name, MotionState.STOPPED
        return [
            Report(at=now, robot=name, epoch=EPOCH, plant=EPOCH, boot_id=1, state=still, node=0, homed=True)
        ]

    def by_hand(self) -> None:
        """Clear alarms and enable the arm at its pendant."""
        assert self._driver is not None
        for line in ("ClearError()", "PowerOn()", "EnableRobot()"):
            self._driver.tell(line)


class MoveCounter(Loopback):
    """Driver's machine that counts the moves given to it."""

    given = 0

    def ask(self, command: Command) -> str | None:
        self.given += isinstance(command, MoveJoints)
        return super().ask(command)


def _degrees(joints: Sequence[float]) -> tuple[float, ...]:
    return tuple(math.degrees(each) for each in joints)
