"""Ride in time: from rest to rest between its points, each by a polynomial of degree five."""

from __future__ import annotations

from dataclasses import dataclass

Position = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Ride:
    """Ride; `points` are times (s of any clock) and positions, the first of them its start."""

    points: tuple[tuple[float, Position], ...]

    @property
    def middle_at(self) -> float:
        return (self.points[0][0] + self.ends_at) / 2

    @property
    def ends_at(self) -> float:
        return self.points[-1][0]

    @property
    def goal(self) -> Position:
        return self.points[-1][1]

    def at(self, now: float) -> Position:
        before = self.points[0]
        for after in self.points[1:]:
            if now < after[0]:
                return _between(before, after, now)
            before = after
        return before[1]

    def cut(self, share: float) -> Ride:
        """The same ride, which ends at that share of its last leg."""
        *before, (ends_at, goal) = self.points
        start = before[-1][1]
        end = tuple(a + (b - a) * share for a, b in zip(start, goal, strict=True))
        return Ride(points=(*before, (ends_at, end)))

    def passed(self, now: float) -> int:
        """The number of points after the start that the ride has passed."""
        return sum(at <= now for at, _ in self.points[1:])


def _between(before: tuple[float, Position], after: tuple[float, Position], now: float) -> Position:
    (began_at, start), (ends_at, goal) = before, after
    part = max(0.0, (now - began_at) / (ends_at - began_at))
    smooth = part**3 * (10 - 15 * part + 6 * part**2)
    return tuple(a + (b - a) * smooth for a, b in zip(start, goal, strict=True))
