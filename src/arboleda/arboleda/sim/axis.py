"""One axis of an arm: a stepper whose undisturbed moves are looked up instead of stepped through."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from functools import lru_cache

from .stepper import Stepper

COURSES = 512  # kept at once, some 10 kB each; a cell at work drives a few dozen


class Course:
    """A stepper's move from rest to rest over `distance` > 0 steps; times in us since its first step."""

    def __init__(self, max_speed: float, acceleration: float, distance: int) -> None:
        self._times = array("q")  # of the steps after which the interval is another one
        self._steps = array("q")  # taken by then
        self._intervals = array("q")  # from then on
        stepper = Stepper()
        stepper.set_max_speed(max_speed)
        stepper.set_acceleration(acceleration)
        stepper.move_to(distance)
        begin = now = stepper.interval
        interval = 0
        while stepper.interval:
            now = stepper.cruise(now)
            stepper.run(now)
            if stepper.interval != interval:
                interval = stepper.interval
                self._times.append(now - begin)
                self._steps.append(stepper.position)
                self._intervals.append(interval)
            now += interval
        self.duration_us = now - begin

    def steps(self, elapsed_us: int) -> int:
        """How many steps are taken by a time before the last one."""
        if elapsed_us < 0:
            return 0
        index = bisect_right(self._times, elapsed_us) - 1
        return self._steps[index] + (elapsed_us - self._times[index]) // self._intervals[index]

    def interval_us(self, elapsed_us: int) -> int:
        """The time between steps at a time between the first step and the last."""
        return self._intervals[bisect_right(self._times, elapsed_us) - 1]


_course = lru_cache(maxsize=COURSES)(Course)


class Axis:
    """Polls a stepper every microsecond, as far as anybody can tell; `position` in steps, for reading.

    A move from rest follows its course; only where it is disturbed does the stepper catch up with it.
    """

    def __init__(self, *, max_speed: float, acceleration: float) -> None:
        self.position = 0
        self._stepper = Stepper()
        self._stepper.set_max_speed(max_speed)
        self._stepper.set_acceleration(acceleration)
        self._now_us = 0
        self._course: Course | None = None  # while it has one, the stepper waits where it begins
        self._begin_us = self._first_step_us = 0

    @property
    def target(self) -> int:
        """The position it heads for."""
        return self._stepper.target

    @property
    def still_at_us(self) -> int:
        """The time of the last step if nobody interferes; now while still."""
        if self._course is None:
            return self._stepper.still_at_us(self._now_us)
        return self._first_step_us + self._course.duration_us

    @property
    def speed(self) -> float:
        """How fast it turns, steps/s, without a sign."""
        elapsed_us = self._now_us - self._first_step_us
        if self._course is None or elapsed_us < 0:
            return abs(self._stepper.speed)
        return 1e6 / self._course.interval_us(elapsed_us)

    def move_to(self, now_us: int, target: int) -> None:
        """Head for an absolute position."""
        self._leave_course(now_us)
        stepper, rested = self._stepper, not self._stepper.interval
        stepper.move_to(target)
        first_step_us = stepper.next_step_us(now_us)
        if rested and first_step_us is not None:
            self._course = _course(stepper.max_speed, stepper.acceleration, abs(target - self.position))
            self._begin_us, self._first_step_us = now_us, first_step_us

    def stop(self, now_us: int) -> None:
        """Head for the nearest position that the deceleration allows."""
        self._leave_course(now_us)
        self._stepper.stop()

    def shift(self, steps: int) -> None:
        """Call the place where it is, and the one it heads for, by other numbers; the move goes on."""
        self._leave_course(self._now_us)
        self._stepper.shift(steps)
        self.position += steps

    def advance(self, now_us: int) -> None:
        """Take every step that is due."""
        stepper, course = self._stepper, self._course
        if course is None:
            if stepper.interval:
                stepper.advance(self._now_us, now_us)
                self.position = stepper.position
        elif now_us < self._first_step_us + course.duration_us:
            steps = course.steps(now_us - self._first_step_us)
            self.position = stepper.position + (steps if stepper.target > stepper.position else -steps)
        else:
            stepper.arrive(self.still_at_us)
            self.position, self._course = stepper.target, None
        self._now_us = now_us

    def _leave_course(self, now_us: int) -> None:
        if self._course is not None and self.position != self._stepper.position:
            self._stepper.advance(self._begin_us, self._now_us)
        self._course = None
        self._now_us = now_us
