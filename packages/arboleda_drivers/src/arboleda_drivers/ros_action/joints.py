"""Joints among the joint states of ROS 2."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .events import Measurement
from .goal import REST, Rest

SILENT_S = 1.0  # joint states come many times a second
FAR = 1e6  # m or rad; no robot measures more, and larger numbers could overflow


@dataclass(frozen=True, kw_only=True)
class JointStateEvent(Measurement):
    """Joint state."""

    names: tuple[str, ...]
    positions: tuple[float, ...]


class Joints:
    """Positions of some joints, and their rest; a state that lacks one, or comes again, is ignored."""

    def __init__(self, names: Sequence[str], topic: str, *, rest: float = REST) -> None:
        self.names = tuple(names)
        self.q: tuple[float, ...] | None = None
        self.measured_at = -math.inf
        self.rest = Rest(rest)
        self._topic = topic
        self._stamp: tuple[int, int] | None = None

    def see(self, now: float, event: Measurement) -> bool:
        if not isinstance(event, JointStateEvent) or len(event.names) != len(event.positions):
            return False
        at = dict(zip(event.names, event.positions, strict=True))
        q = tuple(at.get(name, math.nan) for name in self.names)
        if event.stamp == self._stamp or not all(abs(value) < FAR for value in q):
            return False
        self.q, self._stamp, self.measured_at = q, event.stamp, now
        self.rest.look(now, q)
        return True

    def missing(self, now: float) -> str:
        if now < self.measured_at + SILENT_S:
            return ""
        return f"{self._topic} has said nothing new of {', '.join(self.names)} for {SILENT_S:g} s"
