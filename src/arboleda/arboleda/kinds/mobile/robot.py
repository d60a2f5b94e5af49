"""Mobile robot on a grid of nodes: its position, its commands, and what its reports can say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import ClassVar

from arboleda.model.commands import Position
from arboleda.model.messages import Report
from arboleda.model.plant_model import JointStates, Robot

from .commands import FollowPath
from .grid import Grid
from .motion import GridMotion


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

    @cached_property
    def joint_states(self) -> JointStates:
        names = (f"{self.name}_x_joint", f"{self.name}_y_joint")
        return JointStates(twin=self.name, joints=names, measured=partial(_on_floor, self.grid))

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
        return GridMotion(self.grid, self.speed)

    def go(self, *, id: str, way: Sequence[Position]) -> FollowPath:
        return FollowPath(id=id, robot=self.name, nodes=tuple(node for node in way if isinstance(node, int)))


def _on_floor(grid: Grid, report: Report) -> tuple[float, ...] | None:
    return None if report.node is None else grid.position(report.node)
