"""The driver of an arm of servos and a virtual one, under a clock that tests move."""

from __future__ import annotations

import math

from tests.packages import ROOT

from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState
from arboleda.plant_file.loader import load
from arboleda_drivers.serial_arm.machine import Machine
from arboleda_drivers.serial_arm.settings import Settings
from arboleda_drivers.serial_arm.virtual.faults import FAULTS
from arboleda_drivers.serial_arm.virtual.machine import VirtualServos
from arboleda_drivers.virtual.faults import Faults

from ..connections.stream_rig import StreamRig

EXAMPLE = ROOT / "examples/serial_arm/desk.yaml"
MODEL = load(EXAMPLE)
(ARM,) = (robot for robot in MODEL.robots.values() if isinstance(robot, Arm))
assert ARM.driver is not None and isinstance(ARM.driver.settings, Settings)
SETTINGS = ARM.driver.settings
POLL_S = 0.05  # what is fewer rounds than a real one's shows all that matters


def settings(**changes: object) -> Settings:
    return Settings(**{**vars(SETTINGS), **changes})  # type: ignore[arg-type]


class ServoRig(StreamRig):
    """Machine of the driver and virtual servos."""

    def __init__(self, maker: str = "feetech", *on: str, torque: bool = True, **changes: object) -> None:
        self.faults = Faults(FAULTS, on)
        self.servos = VirtualServos(self.faults, maker=maker, torque=torque)
        machine = Machine([ARM], settings(protocol=maker, poll_s=POLL_S, speed_percent=60, **changes))
        super().__init__(ARM, machine, self.servos)

    def move(self, *degrees: float) -> str:
        return self.ask(MoveJoints(id=self.id(), robot=ARM.name, q=tuple(map(math.radians, degrees))))

    def grip(self, *, on: bool) -> str:
        return self.ask(SetEffector(id=self.id(), robot=ARM.name, on=on))


STILL = MotionState.STOPPED
