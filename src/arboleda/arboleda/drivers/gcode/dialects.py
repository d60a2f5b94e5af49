"""Dialects of the driver `gcode`: the machine for the firmware that the plant file names."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.plant_model import Robot

from .grbl import GrblMachine
from .machine import Machine
from .marlin import MarlinMachine
from .settings import Settings


def machine(devices: Sequence[Robot], settings: Settings) -> Machine:
    """The machine of axes that speaks the dialect of its settings."""
    return (GrblMachine if settings.dialect == "grbl" else MarlinMachine)(devices, settings)
