"""Movement of mobile robots."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.commands import Position
from arboleda.model.movement import Movement

from .grid import Grid


class GridMotion(Movement):
    """Movement over the edges of a grid, at one speed."""

    def __init__(self, grid: Grid, speed: float) -> None:
        self.grid, self.speed = grid, speed

    def route(self, start: Position | None, goal: Position) -> tuple[Position, ...]:
        """A route along the edges of its grid."""
        assert isinstance(goal, int)
        return self.grid.route(start, goal) if isinstance(start, int) else (goal,)

    def beyond(self, position: Position) -> str | None:
        if isinstance(position, int) and 0 <= position < self.grid.size:
            return None
        return f"node {position} is none of its {self.grid.size}"

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """The time of a path, s; one edge is added for a robot that starts elsewhere."""
        return len(way) * self.grid.pitch / self.speed
