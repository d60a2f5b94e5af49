"""Dialects of the driver `gcode`: the machine for the firmware that the plant file names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from arboleda.model.plant_model import Robot

from .grbl import GrblMachine
from .machine import Machine
from .marlin import MarlinMachine
from .moonraker import MoonrakerMachine
from .settings import Settings

MACHINES: Mapping[str, Callable[[Sequence[Robot], Settings], Machine]] = {
    "grbl": GrblMachine,
    "marlin": MarlinMachine,
    "moonraker": MoonrakerMachine,
}


def machine(devices: Sequence[Robot], settings: Settings) -> Machine:
    """The machine of axes that speaks the dialect of its settings."""
    return MACHINES[settings.dialect](devices, settings)
