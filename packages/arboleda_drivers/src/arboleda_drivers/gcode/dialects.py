"""Dialects of the driver `gcode`: the machine for the firmware that the plant file names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from arboleda.drivers import Robot
from arboleda_drivers.connections.controller_machine import ControllerMachine

from .controller import GcodeController
from .grbl import Grbl
from .marlin import Marlin
from .moonraker import Moonraker
from .settings import Settings

DIALECTS: Mapping[str, Callable[[Sequence[Robot], Settings], GcodeController]] = {
    "grbl": Grbl,
    "marlin": Marlin,
    "moonraker": Moonraker,
}


def machine(devices: Sequence[Robot], settings: Settings) -> ControllerMachine:
    """The machine of axes that speaks the dialect of its settings; raises ValueError for other devices."""
    return ControllerMachine(DIALECTS[settings.dialect](devices, settings), report_s=settings.poll_s)
