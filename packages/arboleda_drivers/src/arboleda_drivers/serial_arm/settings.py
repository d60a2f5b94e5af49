"""The keys of the driver in a plant file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Literal

from arboleda.drivers import HEALTH, Arm, DriverError, Evidence, Jointed, Robot
from arboleda_drivers.connections.stream import StreamAddress

from .packets import HIGHEST_ID
from .servos import MAKERS, TICKS

GRIPPER = "gripper"


@dataclass(frozen=True, kw_only=True)
class ServoJoint:
    """Servo of one joint: where the joint's zero is, in ticks, its direction, and its limits in ticks."""

    id: int
    zero: int = TICKS // 2
    reversed: bool = False
    least: int | None = None
    most: int | None = None

    def __post_init__(self) -> None:
        _check_id(self.id)
        if self.least is not None and self.most is not None and self.least >= self.most:
            raise DriverError(f"least is {self.least} and most is {self.most}; least must be the smaller one")

    def ticks(self, angle: float) -> int:
        """The position for an angle of the joint, rad."""
        return self.zero + round(self._sign * angle * TICKS / math.tau)

    def angle(self, ticks: int) -> float:
        """The angle of the joint, rad, at a position."""
        return self._sign * (ticks - self.zero) * math.tau / TICKS

    def can_reach(self, ticks: int, ends: tuple[int, int]) -> bool:
        """True if the position is within the limits; `ends` are those of the servo."""
        least, most = ends
        return max(least, self.least or least) <= ticks <= (most if self.most is None else self.most)

    @property
    def _sign(self) -> int:
        return -1 if self.reversed else 1


@dataclass(frozen=True, kw_only=True)
class ServoGripper:
    """Servo of the gripper: its positions open and closed, in ticks; `near` is how exactly it gets there."""

    id: int
    open: int
    closed: int
    near: int = 40
    ticks_per_s: int = 1500

    def __post_init__(self) -> None:
        _check_id(self.id)
        if abs(self.open - self.closed) <= 2 * self.near:
            raise DriverError(f"open and closed are nearer than twice near, {self.near} ticks, to each other")
        if not 1 <= self.ticks_per_s <= 0x7FFF:
            raise DriverError(f"ticks_per_s is {self.ticks_per_s}; allowed: 1 to {0x7FFF}")


@dataclass(frozen=True, kw_only=True)
class Settings(StreamAddress):
    """Settings of the driver `serial_arm`: the line, and the servo of each joint with its calibration."""

    baud: int = 1_000_000
    protocol: Literal["feetech", "dynamixel"] = "feetech"
    joints: tuple[ServoJoint, ...]
    gripper: ServoGripper | None = None
    speed_percent: int = 30
    poll_s: float = 0.02
    reply_s: float = 0.05
    home_clears_faults: ClassVar[bool] = True  # homing ends alarms and switches the torque on

    def __post_init__(self) -> None:
        super().__post_init__()
        ids = [servo.id for servo in self.servos]
        if twice := {id for id in ids if ids.count(id) > 1}:
            raise DriverError(f"servo {min(twice)} is there twice")
        if not 1 <= self.speed_percent <= 100:
            raise DriverError(f"speed_percent is {self.speed_percent}; allowed: 1 to 100")
        if not 0.002 <= self.poll_s <= 0.5:
            raise DriverError(f"poll_s is {self.poll_s:g}; allowed: 0.002 to 0.5")
        if not 0.005 <= self.reply_s <= 0.2:
            raise DriverError(f"reply_s is {self.reply_s:g}; allowed: 0.005 to 0.2")
        least, most = MAKERS[self.protocol].positions
        for servo in self.joints:
            for name, value in (("zero", servo.zero), ("least", servo.least), ("most", servo.most)):
                if value is not None and not least <= value <= most:
                    raise DriverError(f"{name} of servo {servo.id} is {value}; allowed: {least} to {most}")
        for name in ("open", "closed") if self.gripper else ():
            if not least <= getattr(self.gripper, name) <= most:
                raise DriverError(f"{name} of the gripper is not from {least} to {most}")

    @property
    def servos(self) -> tuple[ServoJoint | ServoGripper, ...]:
        """All servos, those of joints first."""
        return (*self.joints, *([self.gripper] if self.gripper else []))

    @property
    def model_speed_share(self) -> float:
        """The share of the model's speed at which the arm is moved."""
        return self.speed_percent / 100

    @property
    def reported_facts(self) -> tuple[str, ...]:
        """The facts that the driver reports beside those of the arm's kind."""
        load = ("load_percent",) if self.protocol == "feetech" else ()
        return (HEALTH, "torque", "celsius", "volts", *load, *(("hand",) if self.gripper else ()))

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Jointed):
            yield (), f"{device.name} has no joints; this driver moves robots of joints"
            return
        if len(self.joints) != len(device.joints):
            there = (
                f"there are {len(self.joints)} servos for the {len(device.joints)} joints of {device.name}"
            )
            yield ("joints",), there
        for at, joint in enumerate(device.joints):
            if joint.unit != "rad":
                yield ("joints", at), f"{joint.name} slides; a servo turns a joint"
        if self.gripper is not None and not isinstance(device, Arm):
            yield (GRIPPER,), f"{device.name} is no arm and has no effector"
        if device.evidence is not Evidence.IDS:
            yield (), f"{device.name} has evidence: {device.evidence.value}; this driver proves ids"


def _check_id(id: int) -> None:
    if not 0 <= id <= HIGHEST_ID:
        raise DriverError(f"id is {id}; allowed: 0 to {HIGHEST_ID}")
