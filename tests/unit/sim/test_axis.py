"""An axis is its stepper polled every microsecond, whoever interferes and whenever somebody looks."""

from __future__ import annotations

import copy
import math

from hypothesis import example, given
from hypothesis import strategies as st

from arboleda.sim.axis import Axis
from arboleda.sim.motors import FASTEST, STEEPEST
from arboleda.sim.stepper import Stepper

BOOT_US = 10_000_000
speeds = st.floats(min_value=50, max_value=5000)
accelerations = st.floats(min_value=100, max_value=20_000)
starts = st.integers(min_value=0, max_value=2**33)
positions = st.integers(min_value=-1500, max_value=1500)
delays = st.one_of(
    st.integers(0, 900_000),
    st.integers(0, 3),
    st.just(30_000_000),  # until it rests
    st.just(2**32 - 40),  # until the clock shows nearly the same again
)
acts = st.one_of(
    st.tuples(st.just("move_to"), positions),
    st.tuples(st.just("shift"), positions),
    st.just(("stop", None)),
    st.just(("look", None)),
)
scripts = st.lists(st.tuples(delays, acts), max_size=8)


def pair(speed: float, acceleration: float) -> tuple[Axis, Stepper]:
    stepper = Stepper()
    stepper.set_max_speed(speed)
    stepper.set_acceleration(acceleration)
    return Axis(max_speed=speed, acceleration=acceleration), stepper


def act(axis: Axis, stepper: Stepper, now: int, name: str, value: int | None) -> None:
    if name == "move_to":
        axis.move_to(now, value or 0)
        stepper.move_to(value or 0)
    elif name == "shift":
        axis.shift(value or 0)
        stepper.shift(value or 0)
    elif name == "stop":
        axis.stop(now)
        stepper.stop()


def still_at_us(stepper: Stepper, now: int) -> int:
    """When it takes its last step, found by taking them all; `now` while still."""
    ahead = copy.copy(stepper)
    while (due := ahead.next_step_us(now)) is not None:
        ahead.step(due)
        now = due
    return now


def agree(axis: Axis, stepper: Stepper, now: int) -> None:
    shown = axis.position, axis.target, axis.speed, axis.still_at_us
    assert shown == (stepper.position, stepper.target, abs(stepper.speed), still_at_us(stepper, now))


@given(speed=speeds, acceleration=accelerations, start=starts, script=scripts)
@example(speed=100.0, acceleration=100.0, start=BOOT_US, script=[(0, ("move_to", 90)), (0, ("stop", None))])
def test_an_axis_is_where_its_stepper_would_be(speed, acceleration, start, script):
    (axis, stepper), now = pair(speed, acceleration), start
    axis.advance(now)
    for delay, (name, value) in script:
        act(axis, stepper, now, name, value)
        agree(axis, stepper, now)
        stepper.advance(now, now + delay)
        now += delay
        axis.advance(now)
        agree(axis, stepper, now)


@given(
    speed=st.floats(min_value=0.1, max_value=FASTEST),
    exponent=st.floats(min_value=-1, max_value=math.log10(STEEPEST)),
    target=positions,
    looks=st.lists(st.floats(min_value=0, max_value=1), max_size=20),
)
def test_an_undisturbed_move_is_the_steppers_at_every_moment(speed, exponent, target, looks):
    axis, stepper = pair(speed, min(10**exponent, STEEPEST))
    act(axis, stepper, BOOT_US, "move_to", target)
    end, seen = axis.still_at_us, BOOT_US
    for part in sorted([*looks, 1.0]):
        now = BOOT_US + round((end - BOOT_US) * part)
        stepper.advance(seen, now)
        axis.advance(now)
        agree(axis, stepper, now)
        seen = now
    assert axis.position == target
    assert axis.still_at_us == end


def test_a_move_disturbed_before_its_first_step_has_taken_none():
    axis, stepper = pair(1000, 1000)
    for each in (500, -500):
        act(axis, stepper, BOOT_US, "move_to", each)
    assert axis.position == 0
    agree(axis, stepper, BOOT_US)
