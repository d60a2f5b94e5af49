"""Placement of things on the floor."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Placement:
    """A pose on the floor of the `world` frame: m, m, rad."""

    x: float
    y: float
    yaw: float = 0.0

    @property
    def on_floor(self) -> list[float]:
        return [self.x, self.y, self.yaw]
