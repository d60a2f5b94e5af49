"""Axis of an arm: a stepper whose moves are looked up instead of stepped through."""

from __future__ import annotations

from .course import Course, course
from .stepper import Stepper


class Axis:
    """Axis that behaves as if its stepper were polled every microsecond; `position` in steps, for reading."""

    def __init__(self, *, max_speed: float, acceleration: float) -> None:
        self.position = 0
        self._stepper = Stepper()  # somewhere on its course, or at rest
        self._stepper.set_max_speed(max_speed)
        self._stepper.set_acceleration(acceleration)
        self._now_us = 0
        self._course: Course | None = None  # while it moves
        self._begin_us = self._origin = 0  # time and place of the course's begin
        self._polled_us = 0  # since the course began; 0 = not yet
        self._forward = 1  # of the course; -1 = counterclockwise

    @property
    def target(self) -> int:
        """The position that it heads for."""
        return self._stepper.target

    @property
    def still_at_us(self) -> int:
        """The time of the last step if nobody interferes; now while still."""
        return self._begin_us + self._course.duration_us if self._course else self._now_us

    @property
    def speed(self) -> float:
        """The speed of the axis, steps/s, without a sign."""
        self._catch_up()
        return abs(self._stepper.speed)

    def move_to(self, now_us: int, target: int) -> None:
        """Head for an absolute position."""
        self._catch_up()
        self._stepper.move_to(target)
        self._set_out(now_us)

    def stop(self, now_us: int) -> None:
        """Head for the nearest position that the deceleration allows."""
        self._catch_up()
        self._stepper.stop()
        self._set_out(now_us)

    def shift(self, steps: int) -> None:
        """Renumber the present position and the target; the move goes on."""
        self._stepper.shift(steps)
        self._origin += steps
        self.position += steps

    def advance(self, now_us: int) -> None:
        """Take every step that is due."""
        self._now_us = now_us
        if self._course is None:
            return
        self._polled_us = now_us - self._begin_us
        if self._polled_us < self._course.duration_us:
            self.position = self._origin + self._forward * self._course.steps(self._polled_us)
        else:
            self._stepper.arrive(self.still_at_us)
            self.position, self._course = self._stepper.target, None

    def _set_out(self, now_us: int) -> None:
        """Find the course from the stepper's present state."""
        stepper, self._now_us = self._stepper, now_us
        first_step_us = stepper.next_step_us(now_us)
        if first_step_us is None:
            self._course = None
            return
        forward = self._forward = 1 if stepper.speed > 0.0 else -1
        pace = stepper.pace if forward > 0 else stepper.pace.mirrored
        self._course = course(
            stepper.max_speed, stepper.acceleration, forward * (stepper.target - stepper.position), pace
        )
        self._begin_us, self._origin, self._polled_us = first_step_us - stepper.interval, stepper.position, 0

    def _catch_up(self) -> None:
        """Let the stepper take the steps that were due at the last poll."""
        if self._course is None or not self._polled_us:
            return
        time_us, steps, pace = self._course.last_mark(self._polled_us)
        time_us += self._begin_us
        pace = pace if self._forward > 0 else pace.mirrored
        self._stepper.resume(self._origin + self._forward * steps, pace, time_us)
        self._stepper.advance(time_us, self._begin_us + self._polled_us)
