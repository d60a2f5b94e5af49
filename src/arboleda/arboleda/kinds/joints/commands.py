"""Commands of robots of joints."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.commands import Motion, Position


@dataclass(frozen=True, kw_only=True)
class MoveJoints(Motion):
    """Drive a robot to the joint positions `q`, one for each joint: rad, or m for a prismatic joint."""

    q: tuple[float, ...]

    @property
    def way(self) -> tuple[Position, ...]:
        return (self.q,)
