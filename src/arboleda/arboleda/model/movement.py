"""Movement of a robot between positions."""

from __future__ import annotations

from collections.abc import Sequence

from .commands import Position


class Movement:
    """Ways of a robot, the time that they take, and which positions count as one."""

    def route(self, start: Position | None, goal: Position) -> tuple[Position, ...]:
        """The positions from `start`, where that is known, to `goal`, which is the last."""
        return (goal,)

    def beyond(self, position: Position) -> str | None:
        """The first thing of a position that is beyond its limits, in words; None where all is within."""
        return None

    def stride(self, here: Position, goal: Position, *, turn: float, slide: float) -> tuple[Position, ...]:
        """The positions of a short move towards a goal, at most as fast as `turn` rad/s and `slide` m/s."""
        return self.route(here, goal)[:2]

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """The time of a motion along `way`, s; from an unknown start the longest possible time."""
        raise NotImplementedError

    def can_have_moved(self, before: Position, after: Position, elapsed_s: float) -> bool:
        """True where its limits allow it to come from one position to the other in that time."""
        return True

    def stands_at(self, position: Position, goal: Position) -> bool:
        """True where a reported position is that goal."""
        return position == goal

    def confuses(self, position: Position, other: Position) -> bool:
        """True where a robot that stops at one position may count as standing at the other."""
        return position == other

    def held_at(self, position: Position) -> Position:
        """The position as its motors can hold it."""
        return position

    def is_between(self, position: Position, start: Position, end: Position) -> bool:
        """True where a reported position is on the straight way from one position to another."""
        return position in (start, end)

    def lifted(self, position: Position, heights: Sequence[Position]) -> Position:
        """The position, raised to all of these heights where that is possible."""
        return position
