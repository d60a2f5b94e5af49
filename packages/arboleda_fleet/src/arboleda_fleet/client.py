"""Methods of this package for the client of a plant: of each `Plant`, and with types, `Fleet(plant)`."""

from __future__ import annotations

from arboleda.client import Awaiting, Blocking, Routes, route

from .oee.answers import CellOee

__all__ = ["AsyncFleet", "Fleet"]


class FleetRoutes(Routes):
    """Methods that a plant has where this package is installed."""

    @route("GET", "/api/oee", list[CellOee])
    def oee(self, *, cell: str = "", since: float | None = None, until: float | None = None) -> None:
        """The OEE of the cells, of the last 24 hours where no time is given (Unix times, in seconds)."""


class Fleet(FleetRoutes, Blocking):
    """Methods of Fleet for a plant, with types: `Fleet(plant).oee()` is `plant.oee()`."""


class AsyncFleet(FleetRoutes, Awaiting):
    """Methods of Fleet for an AsyncPlant, to be awaited."""
