"""What this package adds to the client of a plant: methods of each `arboleda.client.Plant`, and the same with
types, `Fleet(plant)`."""

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
    """What this package adds to a plant, with types: `Fleet(plant).oee()` is `plant.oee()`."""


class AsyncFleet(FleetRoutes, Awaiting):
    """What this package adds to an AsyncPlant: the methods of Fleet, to be awaited."""
