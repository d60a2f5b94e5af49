"""Commands of mobile robots."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.commands import Motion, Position


@dataclass(frozen=True, kw_only=True)
class FollowPath(Motion):
    """Drive a mobile robot over `nodes` of its grid, one after the other to the last."""

    nodes: tuple[int, ...]

    @property
    def way(self) -> tuple[Position, ...]:
        return self.nodes
