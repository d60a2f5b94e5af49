"""Campaign of the example's arm of servos under faults: a part is carried from one spot to another one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from arboleda.kinds.arm import Arm
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.serial_arm.machine import Machine
from arboleda_drivers.serial_arm.packets import Instruction, PacketReader
from arboleda_drivers.serial_arm.servos import MAKERS
from arboleda_drivers.serial_arm.settings import Settings
from arboleda_drivers.serial_arm.virtual.faults import FAULTS
from arboleda_drivers.serial_arm.virtual.machine import VirtualServos

from .rig import Causes, Hear, Rig
from .stream_loopback import Loopback

POLL_S = 0.08  # a quarter of the usual rounds is enough to see every state
NEAR_TICKS = 30
HOLD_UNITS = 100  # of acceleration: a hold has more, a move less

NO_WORK = {Reason.DEVICE_FAULT, Reason.REJECTED, Reason.NOT_HOMED}
NO_LINK = {Reason.LINK_LOST}
CAUSES: Causes = {
    "overload": NO_WORK,
    "overheating": NO_WORK,
    "low_voltage": NO_WORK,
    "torque_off": NO_WORK,
    "mute_servo": NO_LINK,
    "mute": NO_LINK,
    "power_cycle": {Reason.REBOOTED, *NO_LINK, *NO_WORK},
    "unplugged": NO_LINK,
    "broken_frames": NO_LINK,
    "torn": NO_LINK,
    "old_position": {Reason.NOT_REACHED, *NO_WORK},
    "noise": set(),
    "echo": set(),
    "late": NO_LINK,
    "wrong_id": NO_LINK,
    "no_goal": {Reason.REJECTED, Reason.STOP_UNCONFIRMED},
    "another_master": {Reason.DEVICE_FAULT},
    "pushed": {Reason.NOT_REACHED, Reason.DEADLINE, Reason.DEVICE_FAULT},
    "stall": {Reason.DEVICE_FAULT, Reason.NOT_REACHED},
    "deaf": {Reason.REJECTED, Reason.STOP_UNCONFIRMED},
    "slow": {Reason.DEADLINE},
    "gripper_stuck": {Reason.REJECTED, Reason.DEADLINE},
    "part": set(),
    "wrong_mode": set(),
}


class ServoRig(Rig):
    """Test with parts that go from left to right; it sees where the servos and the gripper truly are."""

    driver = "serial_arm"
    causes = CAUSES
    work = (("left", True), ("right", True), ("right", False))
    between_s = 12.0

    def __init__(self, example: PlantModel, maker: Literal["feetech", "dynamixel"] = "feetech") -> None:
        super().__init__(FAULTS)
        self._maker = MAKERS[maker]
        (arm,) = (robot for robot in example.robots.values() if isinstance(robot, Arm))
        assert arm.driver is not None and isinstance(arm.driver.settings, Settings)
        self._arm, self.model = arm, example
        self._settings = replace(arm.driver.settings, protocol=maker, poll_s=POLL_S)
        self._servos = VirtualServos(self.faults, maker=maker, torque=True)
        self._driver: Loopback | None = None
        (cell,) = example.cells
        self._spots = {
            name: tuple(servo.ticks(q) for servo, q in zip(self._settings.joints, pose.joints, strict=True))
            for name, pose in cell.reach[arm.name].targets.items()
        }

    @property
    def robots(self) -> Sequence[Robot]:
        return [self._arm]

    def task(self, number: int) -> str:
        return f"desk carry left right #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = Loopback(Machine([self._arm], self._settings), self._servos, hear, now)
        return self._driver

    @property
    def where(self) -> tuple[int, ...]:
        return tuple(self._servos.positions().values())

    def place(self) -> tuple[str, bool] | None:
        gripper = self._settings.gripper
        assert gripper is not None
        *joints, jaw = self._servos.positions().values()
        if gripper.near < abs(jaw - gripper.open) < 500:
            return None
        for name, spot in self._spots.items():
            if all(abs(a - b) < NEAR_TICKS for a, b in zip(joints, spot, strict=True)):
                return (name, abs(jaw - gripper.open) > gripper.near)
        return None

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        return (sum(map(self._is_move, self._driver.written)), self._driver.given)

    def _is_move(self, data: bytes) -> bool:
        """True for a packet that gives all joints new goals; one by which they hold has a short ramp."""
        (packet,) = PacketReader(self._maker.framing, replies=False).feed(data)
        word = self._maker.framing.word
        length = int.from_bytes(packet.data[word : 2 * word], "little")
        rows = packet.data[2 * word :]
        if packet.code != Instruction.SYNC_WRITE or len(rows) != (length + 1) * len(self._settings.joints):
            return False
        return int.from_bytes(rows[1 : 2 if word == 1 else 5], "little") < HOLD_UNITS
