"""The stepper beyond its vectors: properties of any sequence of commands."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.sim.stepper import FOREVER_US, Stepper

BOOT_US = 10_000_000
speeds = st.floats(min_value=50, max_value=5000)
accelerations = st.floats(min_value=100, max_value=20_000)
targets = st.integers(min_value=-1500, max_value=1500)
starts = st.integers(min_value=0, max_value=2**32 - 1)
retargets = st.lists(st.tuples(st.integers(min_value=0, max_value=900_000), targets), max_size=4)


def axis(speed: float, acceleration: float) -> Stepper:
    stepper = Stepper()
    stepper.set_max_speed(speed)
    stepper.set_acceleration(acceleration)
    return stepper


def run_until_still(stepper: Stepper, now: int) -> list[tuple[int, int]]:
    """Every step from `now` on as (time, position)."""
    steps = []
    while (due := stepper.next_step_us(now)) is not None:
        assert stepper.run(due)
        steps.append((due, stepper.position))
        now = due
    return steps


def test_a_new_stepper_stands_still():
    stepper = Stepper()
    assert stepper.next_step_us(BOOT_US) is None
    assert not stepper.run(BOOT_US)
    assert (stepper.position, stepper.target, stepper.speed) == (0, 0, 0.0)


def test_a_step_is_taken_on_its_microsecond_and_not_before():
    stepper = axis(1000, 1000)
    stepper.move_to(5)
    assert stepper.run(BOOT_US)
    due = stepper.next_step_us(BOOT_US)
    assert due == BOOT_US + 18138
    assert not stepper.run(due - 1)
    assert stepper.run(due)


def test_a_late_poll_takes_one_step_only():
    stepper = axis(1000, 1000)
    stepper.move_to(5)
    assert stepper.run(BOOT_US)
    assert stepper.run(BOOT_US + 10_000_000)
    assert not stepper.run(BOOT_US + 10_000_000)
    assert stepper.position == 2


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_refused(value):
    with pytest.raises(ValueError, match="not a finite number"):
        Stepper().set_acceleration(value)
    with pytest.raises(ValueError, match="not a finite number"):
        Stepper().set_max_speed(value)


def test_zero_speed_is_refused_and_zero_acceleration_ignored():
    stepper = axis(1000, 800)
    stepper.set_acceleration(0)
    assert stepper.acceleration == 800
    with pytest.raises(ValueError, match="must not be 0"):
        stepper.set_max_speed(0)


@given(speed=speeds, acceleration=accelerations, target=targets, start=starts, changes=retargets)
def test_whatever_the_retargets_the_last_target_is_reached(speed, acceleration, target, start, changes):
    stepper, now = axis(speed, acceleration), start
    stepper.move_to(target)
    for delay, target in changes:
        stepper.advance(now, now + delay)
        now += delay
        stepper.move_to(target)
    steps = run_until_still(stepper, now)
    assert stepper.position == stepper.target == target
    assert stepper.speed == 0.0
    times = [time for time, _ in steps]
    assert times == sorted(set(times))


@given(speed=speeds, acceleration=accelerations, target=targets, start=starts)
def test_a_move_from_rest_never_turns_back(speed, acceleration, target, start):
    stepper = axis(speed, acceleration)
    stepper.move_to(target)
    direction = 1 if target > 0 else -1
    positions = [position for _, position in run_until_still(stepper, start)]
    assert positions == list(range(direction, target + direction, direction)) if target else not positions


@given(speed=speeds, acceleration=accelerations, target=targets, delay=st.integers(0, 2_000_000))
def test_stop_ends_still_within_the_stopping_distance(speed, acceleration, target, delay):
    stepper = axis(speed, acceleration)
    stepper.move_to(target)
    stepper.advance(BOOT_US, BOOT_US + delay)
    way = stepper.speed**2 / (2 * acceleration) + 1
    before = stepper.position
    stepper.stop()
    run_until_still(stepper, BOOT_US + delay)
    assert stepper.speed == 0.0
    assert abs(stepper.position - before) <= way + 1


def state(stepper: Stepper) -> tuple[object, ...]:
    return tuple(getattr(stepper, name) for name in Stepper.__slots__)


@given(speed=speeds, acceleration=accelerations, changes=retargets)
def test_advancing_ends_in_the_very_state_of_polling(speed, acceleration, changes):
    polled, advanced, now = axis(speed, acceleration), axis(speed, acceleration), BOOT_US
    for delay, target in changes:
        polled.move_to(target)
        advanced.move_to(target)
        end = now + delay
        advanced.advance(now, end)
        while (due := polled.next_step_us(now)) is not None and due <= end:
            polled.run(due)
            now = due
        now = end
        assert state(polled) == state(advanced)


@given(speed=speeds, acceleration=accelerations, target=targets, cut=st.integers(0, 2_000_000))
def test_advancing_in_two_halves_is_advancing_at_once(speed, acceleration, target, cut):
    once, twice = axis(speed, acceleration), axis(speed, acceleration)
    for stepper in (once, twice):
        stepper.move_to(target)
    once.advance(BOOT_US, FOREVER_US)
    twice.advance(BOOT_US, BOOT_US + cut)
    twice.advance(BOOT_US + cut, FOREVER_US)
    assert once.position == twice.position == target
    assert once.interval == twice.interval == 0
