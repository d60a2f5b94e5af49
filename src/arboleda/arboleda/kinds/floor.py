"""Placement of things on the floor."""

from __future__ import annotations

from dataclasses import dataclass, field

from arboleda.model.recipe import FOR_PEOPLE


@dataclass(frozen=True, kw_only=True)
class Placement:
    """A pose on the floor of the `world` frame: m, m, rad. `is_declared`: somebody has said it."""

    x: float
    y: float
    yaw: float = 0.0
    is_declared: bool = field(default=True, compare=False, metadata={FOR_PEOPLE: True})

    @property
    def on_floor(self) -> list[float]:
        return [self.x, self.y, self.yaw]
