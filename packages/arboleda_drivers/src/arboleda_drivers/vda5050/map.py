"""Grid of the plant in a vehicle's terms: names and places of nodes."""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.drivers import Mobile

from .orders import edge_id
from .settings import Settings


class GridMap:
    """Grid of a vehicle; without a mobile robot it has no nodes."""

    def __init__(self, mobile: Mobile | None, settings: Settings) -> None:
        self._mobile = mobile
        self._names = settings.node_names(mobile)
        self._numbers = {name: number for number, name in enumerate(self._names)}

    @property
    def edge_ids(self) -> list[str]:
        """The names of all edges of the grid, in both directions."""
        if self._mobile is None:
            return []
        ends = (
            (start, end) for start in self._numbers.values() for end in self._mobile.grid.neighbours(start)
        )
        return [edge_id(self._names[start], self._names[end]) for start, end in ends]

    def number(self, name: str) -> int | None:
        """The plant's number of a vehicle's node; None if unknown."""
        return self._numbers.get(name)

    def way(self, at: str, nodes: Sequence[int]) -> tuple[str, ...]:
        """The vehicle's names of the nodes of a way, from where it stands."""
        assert self._mobile is not None
        here = self.number(at)
        before = () if here is None else self._mobile.grid.route(here, nodes[0])[:-1]
        return tuple(self._names[node] for node in (*before, *nodes))

    def position(self, name: str) -> tuple[float, float] | None:
        """The position of a node on the floor, m; None if the map has no such node."""
        number = self.number(name)
        if self._mobile is None or number is None:
            return None
        (x, y), origin = self._mobile.grid.position(number), self._mobile.grid.origin
        cos, sin = math.cos(origin.yaw), math.sin(origin.yaw)
        return (round(origin.x + cos * x - sin * y, 6), round(origin.y + sin * x + cos * y, 6))
