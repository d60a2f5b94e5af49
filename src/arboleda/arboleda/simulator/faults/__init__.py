"""Everything that can go wrong, by kind; a file for each family."""

from __future__ import annotations

from . import (
    boards,
    effectors,
    foreigners,
    links,
    operators,
    orchestrators,
    processes,
    sensors,
    telemetry,
)
from .kind import Fault, Kind

__all__ = ["KINDS", "OF_DEVICES", "Fault", "Kind"]

FAMILIES = (boards, telemetry, effectors, sensors, links, processes, orchestrators, operators, foreigners)
KINDS: dict[str, Kind] = {kind.name: kind for family in FAMILIES for kind in family.KINDS}

OF_DEVICES = ("gives_up",)
"""The kinds that befall devices of declared kinds alone: nobody in the packaged plants and in drawn ones."""
