"""Stepper ramp of the boards, step for step (D. Austin, 2005; DESIGN section 11)."""

from __future__ import annotations

import math
from struct import Struct
from typing import NamedTuple

CLOCK_MASK = 0xFFFFFFFF
FOREVER_US = 2**63
_FLOAT = Struct("f")
_store, _load = _FLOAT.pack, _FLOAT.unpack  # the fastest rounding to binary32 in the standard library


class Pace(NamedTuple):
    """State on which the next steps of a stepper depend, besides the way still to go."""

    ramp: int  # number of the next step in the ramp: > 0 speeding up, < 0 slowing down
    interval: float  # us to the next step, exactly; < 0 = counterclockwise, 0 = still

    @property
    def mirrored(self) -> Pace:
        """The same pace in the other direction."""
        return Pace(self.ramp, -self.interval)


class Stepper:
    """One stepper axis; lengths in motor steps, times in microseconds of a clock that wraps at 2^32.

    `position`, `target`, `speed` (steps/s, signed) and `interval` (us to the next step; 0 = still)
    are for reading.
    """

    __slots__ = (
        "_clockwise",
        "_exact_interval",
        "_first_interval",
        "_last_step_us",
        "_ramp",
        "_shortest_interval",
        "acceleration",
        "interval",
        "max_speed",
        "position",
        "speed",
        "target",
    )

    def __init__(self) -> None:
        self.position = self.target = self.interval = 0
        self.speed = self.max_speed = self.acceleration = 0.0
        self._last_step_us = 0
        self._first_interval = self._exact_interval = 0.0
        self._shortest_interval = 1.0
        self._ramp = 0  # number of the next step in the ramp: > 0 speeding up, < 0 slowing down
        self._clockwise = False
        self.set_acceleration(1.0)
        self.set_max_speed(1.0)

    def set_acceleration(self, value: float) -> None:
        """Set the acceleration in steps/s2; 0 is ignored."""
        value = _magnitude(value)
        if value in (0.0, self.acceleration):
            return
        self._ramp = int(_binary32(self._ramp * _binary32(self.acceleration / value)))
        self._first_interval = _binary32(0.676 * math.sqrt(2.0 / value) * 1e6)
        self.acceleration = value
        self._compute()

    def set_max_speed(self, value: float) -> None:
        """Set the speed limit in steps/s."""
        value = _magnitude(value)
        if value == 0.0:
            raise ValueError("the speed limit of a stepper must not be 0")
        if value == self.max_speed:
            return
        self.max_speed = value
        self._shortest_interval = _binary32(1e6 / value)
        if self._ramp > 0:
            self._ramp = self.stopping_distance
            self._compute()

    def move_to(self, target: int) -> None:
        """Head for an absolute position."""
        if target != self.target:
            self.target = target
            self._compute()

    def stop(self) -> None:
        """Head for the nearest position that the deceleration allows."""
        if self.speed != 0.0:
            way = self.stopping_distance + 1
            self.move_to(self.position + (way if self.speed > 0.0 else -way))

    def set_current_position(self, position: int) -> None:
        """Stop at once and call this place `position`."""
        self.position = self.target = position
        self._ramp = self.interval = 0
        self.speed = 0.0

    def arrive(self, at_us: int) -> None:
        """Come to rest at the target, after the last step of the move."""
        self.set_current_position(self.target)
        self._last_step_us = at_us

    @property
    def pace(self) -> Pace:
        """The stepper's present pace."""
        if not self.interval:
            return Pace(0, 0.0)
        return Pace(self._ramp, self._exact_interval if self._clockwise else -self._exact_interval)

    def resume(self, position: int, pace: Pace, at_us: int) -> None:
        """Continue from a step taken at `at_us` towards the target, at this pace."""
        self.position, self._last_step_us = position, at_us
        self._ramp, self._exact_interval = pace.ramp, abs(pace.interval)
        self._clockwise = pace.interval > 0.0
        self.interval = int(self._exact_interval)
        self.speed = _binary32(1e6 / pace.interval) if pace.interval else 0.0

    def shift(self, steps: int) -> None:
        """Renumber the present position and the target; the move goes on."""
        self.position += steps
        self.target += steps

    def run(self, now_us: int) -> bool:
        """Poll once, and take one step if it is due; True if it was."""
        if not self.interval or (now_us - self._last_step_us) & CLOCK_MASK < self.interval:
            return False
        self.step(now_us)
        return True

    def next_step_us(self, now_us: int) -> int | None:
        """The first of the polls at `now_us`, +1, +2, ... that will step; None at rest."""
        if not self.interval:
            return None
        return now_us + max(0, self.interval - ((now_us - self._last_step_us) & CLOCK_MASK))

    def advance(self, since_us: int, until_us: int) -> None:
        """Poll every microsecond from `since_us` to `until_us`, both included."""
        due = self.next_step_us(since_us)
        while due is not None and due <= until_us:
            due = self.cruise(due, until_us)
            if due > until_us:
                return
            self.step(due)
            due = due + self.interval if self.interval else None

    def step(self, now_us: int) -> None:
        """Take the step that is due now."""
        self.position += 1 if self._clockwise else -1
        self._last_step_us = now_us
        self._compute()

    def cruise(self, due: int, until_us: int = FOREVER_US) -> int:
        """Take all steps from `due` on that change only the position; returns when the next is due."""
        if not self.cruises:
            return due
        way = self.target - self.position
        if self._ramp <= 0 or self._clockwise != (way > 0):
            return due
        steps = min(abs(way) - self.stopping_distance - 1, (until_us - due) // self.interval + 1)
        if steps <= 0:
            return due
        self.position += steps if self._clockwise else -steps
        self._ramp += steps
        self._last_step_us = due + (steps - 1) * self.interval
        return due + steps * self.interval

    @property
    def cruises(self) -> bool:
        """True at full speed."""
        return self._exact_interval == self._shortest_interval

    @property
    def stopping_distance(self) -> int:
        """The number of steps that it needs to slow down."""
        return int(_load(_store(self.speed * self.speed))[0] / (2.0 * self.acceleration))

    def _compute(self) -> None:
        """Compute the next interval and speed; one piece, as it runs once per step."""
        distance = self.target - self.position
        stopping = int(_load(_store(self.speed * self.speed))[0] / (2.0 * self.acceleration))
        if distance == 0 and stopping <= 1:
            self.interval = self._ramp = 0
            self.speed = 0.0
            return
        ramp = self._ramp
        if distance != 0:
            towards = self._clockwise == (distance > 0)
            if ramp > 0 and (stopping >= abs(distance) or not towards):
                ramp = -stopping
            elif ramp < 0 and stopping < abs(distance) and towards:
                ramp = -ramp
        if ramp == 0:
            interval = self._first_interval
            self._clockwise = distance > 0
        else:
            interval = self._exact_interval
            interval = _load(_store(interval - 2.0 * interval / (4.0 * ramp + 1.0)))[0]
            if interval < self._shortest_interval:
                interval = self._shortest_interval
        self._ramp = ramp + 1
        self._exact_interval = interval
        self.interval = int(interval)
        speed = _load(_store(1e6 / interval))[0]
        self.speed = speed if self._clockwise else -speed


def _binary32(value: float) -> float:
    return float(_load(_store(value))[0])


def _magnitude(value: float) -> float:
    """|value| in binary32; raises ValueError if it is not finite."""
    if not math.isfinite(value):
        raise ValueError(f"{value} is not a finite number")
    return _binary32(abs(value))
