"""Stations of a cell, and which of them have a part; that outlives the plant."""

from __future__ import annotations

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import Fact
from arboleda.model.plant_model import Cell, Pose

from .cell_robots import CellRobots


class Stations:
    """Books of the stations of one cell; each is known by its number."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher, robots: CellRobots) -> None:
        self._cell = cell
        self._dispatcher = dispatcher
        self._robots = robots

    @property
    def stored(self) -> frozenset[int]:
        """The stations with a part: put there, and not reported as taken out."""
        kept = (self._dispatcher.memory.value(Fact.STORED, self._cell.name) or "").split()
        return frozenset(number for number in range(len(self._cell.stations)) if str(number) in kept)

    def store(self, pose: Pose) -> None:
        """Book a part that was put down at a pose; where that is a station, it stays there."""
        numbers = {number for number, station in enumerate(self._cell.stations) if station.name == pose.name}
        self._keep(self.stored | numbers)

    def store_below(self, robot: str) -> None:
        """Book a part that a robot has put down where it stands; where that is a station, it stays there."""
        here, device = self._robots.position(robot), self._cell.reach[robot].robot
        for station in self._cell.stations:
            if here is not None and device.motion.stands_at(here, device.motion.held_at(station.q)):
                self.store(station)

    def unload(self, station: int | None = None) -> None:
        """Book that somebody has taken the part out of a station, or of all."""
        self._keep(frozenset() if station is None else self.stored - {station})

    def _keep(self, numbers: frozenset[int]) -> None:
        value = " ".join(map(str, sorted(numbers))) or None
        self._dispatcher.memory.remember(Fact.STORED, self._cell.name, value)
