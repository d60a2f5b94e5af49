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

__all__ = ["KINDS", "Fault", "Kind"]

FAMILIES = (boards, telemetry, effectors, sensors, links, processes, orchestrators, operators, foreigners)
KINDS: dict[str, Kind] = {kind.name: kind for family in FAMILIES for kind in family.KINDS}
