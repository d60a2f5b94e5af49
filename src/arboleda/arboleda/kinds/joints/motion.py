"""Movement of robots of joints."""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.model.commands import Position
from arboleda.model.counting import counted
from arboleda.model.movement import Movement

from .joint import Joint

ROUNDING = 1e-9  # rad or m, far below a motor step
STRIDE_S = 0.1  # of a short goal: a robot that is told no other one stands still after that
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

    def is_between(self, position: Position, start: Position, end: Position) -> bool:
        assert isinstance(position, tuple) and isinstance(start, tuple) and isinstance(end, tuple)
        rows = zip(position, self.quantised(start), self.quantised(end), self.tolerances, strict=True)
        return all(min(a, b) - within <= q <= max(a, b) + within for q, a, b, within in rows)

    def confuses(self, position: Position, other: Position) -> bool:
        """True if the robot, stopped within tolerance of one position, may count as standing at the other."""
        assert isinstance(position, tuple) and isinstance(other, tuple)
        rows = zip(self.quantised(position), self.quantised(other), self.tolerances, strict=True)
        return all(abs(a - b) <= 2 * within + ROUNDING for a, b, within in rows)

    def beyond(self, position: Position) -> str | None:
        if not isinstance(position, tuple) or len(position) != len(self.joints):
            return f"it has {counted(len(self.joints), 'joint')}"
        rows = zip(self.joints, position, strict=True)
        return next((_limits(joint) for joint, q in rows if not _is_within(joint, q)), None)

    def stride(self, here: Position, goal: Position, *, turn: float, slide: float) -> tuple[Position, ...]:
        assert isinstance(here, tuple) and isinstance(goal, tuple)
        rows = zip(self.joints, here, goal, self.tolerances, strict=True)
        lengths = [
            abs(there - now) / _stride(joint, turn if joint.pinion_radius_m is None else slide, within)
            for joint, now, there, within in rows
        ]
        part = max(lengths)
        if part <= 1:
            return (goal,)
        return (tuple(now + (there - now) / part for now, there in zip(here, goal, strict=True)),)

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


def _is_within(joint: Joint, value: float) -> bool:
    return joint.lower - joint.step <= value <= joint.upper + joint.step


def _limits(joint: Joint) -> str:
    """The limits of a joint, in words."""
    if joint.pinion_radius_m is None:
        return f"{joint.name} goes from {math.degrees(joint.lower):g} to {math.degrees(joint.upper):g} deg"
    return f"{joint.name} goes from {joint.lower * 1000:g} to {joint.upper * 1000:g} mm"


def _stride(joint: Joint, speed: float, tolerance: float) -> float:
    """The length of a short goal from rest to rest: no faster than that, over in STRIDE_S, and one that the
    robot can be seen to make.
    """
    slow = min(speed, joint.speed) ** 2 / joint.acceleration
    short = joint.acceleration * (STRIDE_S / 2) ** 2
    return max(min(slow, short), joint.step, 2 * tolerance)
