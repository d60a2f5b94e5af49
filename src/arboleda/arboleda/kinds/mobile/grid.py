"""Grid of nodes on the floor, and the ways over it."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from ..floor import Placement


@dataclass(frozen=True, kw_only=True)
class Grid:
    """A rows x columns grid of nodes, numbered row by row from 0; `pitch` m between neighbours."""

    origin: Placement
    pitch: float
    rows: int = 3
    columns: int = 3

    @property
    def size(self) -> int:
        return self.rows * self.columns

    def neighbours(self, node: int) -> tuple[int, ...]:
        """The nodes one 4-neighbour edge away, ascending."""
        row, column = divmod(node, self.columns)
        around = ((row - 1, column), (row, column - 1), (row, column + 1), (row + 1, column))
        return tuple(r * self.columns + c for r, c in around if 0 <= r < self.rows and 0 <= c < self.columns)

    def route(self, start: int, goal: int) -> tuple[int, ...]:
        """A shortest way over 4-neighbours, both ends included; ties go to the lower node."""
        came_from = {start: start}
        frontier = deque([start])
        while goal not in came_from:
            node = frontier.popleft()
            for nearby in self.neighbours(node):
                if nearby not in came_from:
                    came_from[nearby] = node
                    frontier.append(nearby)
        way = [goal]
        while way[-1] != start:
            way.append(came_from[way[-1]])
        return tuple(reversed(way))

    def position(self, node: int) -> tuple[float, float]:
        """x, y of a node in the grid frame, m."""
        row, column = divmod(node, self.columns)
        return (column * self.pitch, row * self.pitch)

    def on_floor(self, node: int) -> tuple[float, float]:
        """x, y of a node in the `world` frame, m."""
        x, y = self.position(node)
        turn = self.origin.yaw
        return (
            self.origin.x + x * math.cos(turn) - y * math.sin(turn),
            self.origin.y + x * math.sin(turn) + y * math.cos(turn),
        )
