"""Movement of a robot from position to position."""

from __future__ import annotations

from collections.abc import Sequence

from .commands import Position


class Movement:
    """Ways of a robot, the time that they take, and which positions count as one."""

    def route(self, start: Position | None, goal: Position) -> tuple[Position, ...]:
        """The positions by which it gets from `start`, where that is known, to `goal`, which is the last."""
        return (goal,)

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """Time of a motion along `way`; from an unknown start the longest possible one."""
        raise NotImplementedError

    def can_have_moved(self, before: Position, after: Position, elapsed_s: float) -> bool:
        """Whether its limits allow it to come from one position to the other in that time."""
        return True

    def stands_at(self, position: Position, goal: Position) -> bool:
        """Whether a reported position is that goal."""
        return position == goal

    def confuses(self, position: Position, other: Position) -> bool:
        """Whether it may stop at the one and count as standing at the other."""
        return position == other

    def held_at(self, position: Position) -> Position:
        """The position as its motors can hold it."""
        return position

    def lifted(self, position: Position, heights: Sequence[Position]) -> Position:
        """The position, raised to all of these heights where that is possible."""
        return position
