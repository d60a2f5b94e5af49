"""Mobile robot on a grid of nodes: its routes and commands."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

from arboleda.model.commands import Motion, Position
from arboleda.model.messages import Report
from arboleda.model.movement import Movement
from arboleda.model.plant_model import Robot

from .floor import Placement


@dataclass(frozen=True, kw_only=True)
class FollowPath(Motion):
    """Drive a mobile robot over `nodes` of its grid, one after the other to the last."""

    nodes: tuple[int, ...]

    @property
    def way(self) -> tuple[Position, ...]:
        return self.nodes


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


@dataclass(frozen=True, kw_only=True)
class Mobile(Robot):
    """Robot on a grid; `speed` in m/s, `model` that of its drawing, empty where it has none."""

    kind_name: str = "mobile"
    model: str = ""
    grid: Grid
    speed: float
    position_key: ClassVar[str | None] = "node"

    @property
    def floor_grid(self) -> Grid:
        return self.grid

    def drawn(self) -> dict[str, object] | None:
        if not self.model:
            return None
        nodes = [list(self.grid.position(node)) for node in range(self.grid.size)]
        at, speeds = self.grid.origin.on_floor, [self.speed, self.speed]
        return {"at": at, "speeds": speeds, "reference": nodes[0], "nodes": nodes}

    @property
    def joint_names(self) -> tuple[str, ...]:
        return (f"{self.name}_x_joint", f"{self.name}_y_joint")

    def measured(self, report: Report) -> tuple[float, ...] | None:
        return None if report.node is None else self.grid.position(report.node)

    def at_rate(self, rate: float) -> Mobile:
        return replace(self, speed=self.speed * rate)

    def objection(self, report: Report) -> str | None:
        for key in ("q", "effector", "piece"):
            if getattr(report, key) is not None:
                return f"{key} was said; {self.name} is a mobile robot and has none"
        if report.node is not None and not 0 <= report.node < self.grid.size:
            return f"node is {report.node}; {self.name} knows {self.grid.size} nodes"
        return None

    @cached_property
    def motion(self) -> GridMotion:
        return GridMotion(self)

    def go(self, *, id: str, way: Sequence[Position]) -> FollowPath:
        return FollowPath(id=id, robot=self.name, nodes=tuple(node for node in way if isinstance(node, int)))


class GridMotion(Movement):
    """Movement over the edges of a grid, at one speed."""

    def __init__(self, robot: Mobile) -> None:
        self.grid, self.pitch, self.speed = robot.grid, robot.grid.pitch, robot.speed

    def route(self, start: Position | None, goal: Position) -> tuple[Position, ...]:
        """A route along the edges of its grid."""
        assert isinstance(goal, int)
        return self.grid.route(start, goal) if isinstance(start, int) else (goal,)

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """The time of a path, s; one edge is added for a robot that starts elsewhere."""
        return len(way) * self.pitch / self.speed
