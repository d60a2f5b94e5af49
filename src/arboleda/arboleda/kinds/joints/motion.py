"""Movement of robots of joints."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.commands import Position
from arboleda.model.movement import Movement

from .joint import Joint

ROUNDING = 1e-9  # rad or m, far below a motor step
KEPT = 64  # goals of a robot, as its motors can hold them


class JointMotion(Movement):
    """Movement of a robot whose joints all start and arrive together, each within its tolerance."""

    def __init__(self, joints: tuple[Joint, ...], tolerances: tuple[float, ...]) -> None:
        self.joints = joints
        self.tolerances = tolerances
        self._held: dict[Position, tuple[float, ...]] = {}  # by goal: every report on the way asks for it
        self._longest_s: float | None = None

    def quantised(self, q: tuple[float, ...]) -> tuple[float, ...]:
        """The joints as their motors can hold them."""
        return tuple(joint.quantised(value) for joint, value in zip(self.joints, q, strict=True))

    def reached(self, q: tuple[float, ...], target: tuple[float, ...]) -> bool:
        """True if reported joints `q` lie within tolerance of a quantised target."""
        for value, goal, tolerance in zip(q, target, self.tolerances, strict=True):
            if not abs(value - goal) <= tolerance:
                return False
        return True

    def held_at(self, position: Position) -> Position:
        assert isinstance(position, tuple)
        return self.quantised(position)

    def lifted(self, position: Position, heights: Sequence[Position]) -> Position:
        """The position with its lifting (prismatic) joints at the highest of `heights`, within limits."""
        assert isinstance(position, tuple)
        rows = zip(self.joints, position, *[up for up in heights if isinstance(up, tuple)], strict=True)
        return tuple(joint.higher(joint.within(q), *above) for joint, q, *above in rows)

    def stands_at(self, position: Position, goal: Position) -> bool:
        assert isinstance(position, tuple) and isinstance(goal, tuple)
        held = self._held.get(goal)
        if held is None:
            if len(self._held) >= KEPT:
                self._held.clear()
            held = self._held[goal] = self.quantised(goal)
        return self.reached(position, held)

    def confuses(self, position: Position, other: Position) -> bool:
        """True if the robot, stopped within tolerance of one position, may count as standing at the other."""
        assert isinstance(position, tuple) and isinstance(other, tuple)
        rows = zip(self.quantised(position), self.quantised(other), self.tolerances, strict=True)
        return all(abs(a - b) <= 2 * within + ROUNDING for a, b, within in rows)

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """Time of a joint move; from an unknown start, or one that cannot be, the longest possible one."""
        if self._longest_s is None:
            self._longest_s = max(joint.travel_s(joint.upper - joint.lower) for joint in self.joints)
        if start is None:
            return self._longest_s
        assert isinstance(start, tuple) and isinstance(way[-1], tuple)
        rows = zip(self.joints, start, way[-1], strict=True)
        return min(self._longest_s, max(joint.travel_s(there - here) for joint, here, there in rows))

    def can_have_moved(self, before: Position, after: Position, elapsed_s: float) -> bool:
        assert isinstance(before, tuple) and isinstance(after, tuple)
        rows = zip(self.joints, before, after, strict=True)
        return all(abs(now - then) <= joint.speed * elapsed_s + 2 * joint.step for joint, then, now in rows)
