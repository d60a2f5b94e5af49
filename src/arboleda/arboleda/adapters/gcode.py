"""The driver `gcode`: machines of axes with GRBL or Marlin on a serial line, or at a TCP port."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.adapters.stream import StreamDriver
from arboleda.drivers.gcode.dialects import machine
from arboleda.drivers.gcode.machine import Machine
from arboleda.drivers.gcode.settings import Settings
from arboleda.drivers.port import driver
from arboleda.model.plant_model import Robot


@driver("gcode", settings=Settings)
class Gcode(StreamDriver):
    """Driver of one machine of axes."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self._settings = settings

    def machine(self, devices: Sequence[Robot]) -> Machine:
        return machine(devices, self._settings)
