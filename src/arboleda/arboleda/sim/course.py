"""Course of a stepper to rest, stepped through once and looked up from then on.

All moves from rest begin with the same ramp, and all that get to full speed slow down in the same way: they
have these parts in common.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from functools import lru_cache

from .stepper import Pace, Stepper

KEPT = 512  # courses and trails at once, some 10 kB each; a cell at work drives a few dozen
RAMPS_KEPT = 128
FAR = 2**62  # steps; no move is as long


class Trail:
    """Steps of a stepper, with a mark wherever the interval between steps changes.

    Times are in us since the first mark, steps are counted from there. With `marks` only the first so many
    count, and the motion goes on as at the last of them.
    """

    def __init__(self) -> None:
        self.duration_us = 0
        self._times = array("q")
        self._steps = array("q")
        self._ramps = array("q")
        self._intervals = array("f")

    def mark(self, time_us: int, stepper: Stepper) -> None:
        """Note the stepper's position and how it moves on."""
        ramp, interval = stepper.pace
        self._times.append(time_us)
        self._steps.append(stepper.position)
        self._ramps.append(ramp)
        self._intervals.append(interval)

    def steps(self, elapsed_us: int, marks: int | None = None) -> int:
        """The steps made after this time."""
        index = bisect_right(self._times, elapsed_us, 0, marks) - 1
        interval = int(self._intervals[index])
        steps = (elapsed_us - self._times[index]) // abs(interval)
        return self._steps[index] + (steps if interval > 0 else -steps)

    def last_mark(self, elapsed_us: int, marks: int | None = None) -> tuple[int, int, Pace]:
        """Time, steps and pace of the last mark before this time."""
        index = bisect_right(self._times, elapsed_us, 0, marks) - 1
        return self._times[index], self._steps[index], Pace(self._ramps[index], self._intervals[index])


class Ramp:
    """Acceleration of a stepper from rest, computed as far as it was needed."""

    def __init__(self, max_speed: float, acceleration: float) -> None:
        self.trail = Trail()
        self._stepper = _stepper(max_speed, acceleration)
        self._stepper.move_to(FAR)
        self._time_us = self._shortest_way = 0
        self._shortest_ways = array("q")  # for each mark, the way below which a move slows down before it
        self._mark()

    def marks(self, distance: int) -> int:
        """The number of marks before a move over `distance` slows down, or before full speed."""
        while self._shortest_way < distance and not self._stepper.cruises:
            self._step()
        return bisect_left(self._shortest_ways, distance)

    def _step(self) -> None:
        stepper = self._stepper
        interval, stopping = stepper.interval, stepper.stopping_distance
        self._time_us += interval
        stepper.step(self._time_us)
        self._shortest_way = max(self._shortest_way, stepper.position + stopping)
        if stepper.interval != interval:
            self._mark()

    def _mark(self) -> None:
        self.trail.mark(self._time_us, self._stepper)
        self._shortest_ways.append(self._shortest_way)


class Course:
    """A stepper's way to rest over `distance` steps, from a pace that is not backwards; times in us."""

    def __init__(self, max_speed: float, acceleration: float, distance: int, pace: Pace) -> None:
        stepper = _stepper(max_speed, acceleration)
        stepper.target = distance
        stepper.resume(0, pace, 0)
        self._up, self._marks, self._turn_us = Trail(), 0, 0
        if pace.ramp == 1 and distance > 0:
            ramp = _ramp(max_speed, acceleration)
            self._up, self._marks = ramp.trail, ramp.marks(distance)
            self._turn_us = self._speed_up(stepper)
        self._turn_steps = stepper.position
        self._down = _trail(max_speed, acceleration, distance - stepper.position, stepper.pace)
        self.duration_us = self._turn_us + self._down.duration_us

    def steps(self, elapsed_us: int) -> int:
        """The steps made forward at a time before the last one."""
        if elapsed_us < self._turn_us:
            return self._up.steps(elapsed_us, self._marks)
        return self._turn_steps + self._down.steps(elapsed_us - self._turn_us)

    def last_mark(self, elapsed_us: int) -> tuple[int, int, Pace]:
        """Time, steps and pace at a time shortly before this one, from which stepping on is cheap."""
        if elapsed_us < self._turn_us:
            return self._up.last_mark(elapsed_us, self._marks)
        time_us, steps, pace = self._down.last_mark(elapsed_us - self._turn_us)
        return self._turn_us + time_us, self._turn_steps + steps, pace

    def _speed_up(self, stepper: Stepper) -> int:
        """Run the stepper until it slows down or rests; returns the time then."""
        now, steps, pace = self._up.last_mark(FAR, self._marks)
        stepper.resume(steps, pace, now)
        while stepper.pace.ramp == stepper.position + 1:
            now = stepper.cruise(now + stepper.interval)
            stepper.step(now)
        return now


def _stepper(max_speed: float, acceleration: float) -> Stepper:
    stepper = Stepper()
    stepper.set_max_speed(max_speed)
    stepper.set_acceleration(acceleration)
    return stepper


@lru_cache(maxsize=KEPT)
def _trail(max_speed: float, acceleration: float, distance: int, pace: Pace) -> Trail:
    """The steps from this pace to rest."""
    stepper, trail = _stepper(max_speed, acceleration), Trail()
    stepper.target = distance
    stepper.resume(0, pace, 0)
    now, marked = 0, 0
    while stepper.interval:
        interval = stepper.interval if stepper.speed > 0.0 else -stepper.interval
        if interval != marked:
            marked = interval
            trail.mark(now, stepper)
        now = stepper.cruise(now + stepper.interval)
        stepper.step(now)
    trail.duration_us = now
    return trail


_ramp = lru_cache(maxsize=RAMPS_KEPT)(Ramp)
course = lru_cache(maxsize=KEPT)(Course)
