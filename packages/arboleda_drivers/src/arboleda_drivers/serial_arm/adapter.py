"""The driver `serial_arm`: arms of bus servos on a serial line, or behind a serial server."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.drivers import Robot, driver
from arboleda_drivers.connections.stream_driver import StreamDriver
from arboleda_drivers.serial_arm.machine import Machine
from arboleda_drivers.serial_arm.settings import Settings


@driver("serial_arm", settings=Settings)
class SerialArm(StreamDriver):
    """Driver of one arm whose servos share a bus."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self._settings = settings

    def machine(self, devices: Sequence[Robot]) -> Machine:
        return Machine(devices, self._settings)
