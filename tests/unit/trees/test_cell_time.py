"""The time of a cell, and the instants at which its tree wants to be ticked again."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from arboleda.trees.cell_time import CellTime


@dataclass
class Clock:
    """The plant's time, moved by hand."""

    now: float = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def time(clock: Clock) -> CellTime:
    return CellTime(clock)


def test_nothing_is_due_where_nothing_waits(time: CellTime) -> None:
    assert time.next_deadline is None
    assert not time.woken()


def test_the_earliest_wake_is_the_deadline(time: CellTime) -> None:
    for at in (105.0, 103.0, 104.0):
        time.wake_at(at)
    assert time.next_deadline == 103.0


def test_a_wake_is_taken_once_and_not_before_its_instant(time: CellTime, clock: Clock) -> None:
    time.wake_at(103.0)
    time.wake_at(105.0)
    assert not time.woken()
    clock.now = 103.0
    assert time.woken()
    assert time.next_deadline == 105.0
    assert not time.woken()


def test_wakes_that_are_due_together_wake_once(time: CellTime, clock: Clock) -> None:
    time.wake_at(101.0)
    time.wake_at(102.0)
    clock.now = 102.5
    assert time.woken()
    assert time.next_deadline is None
    assert not time.woken()


def test_a_cell_that_is_held_waits_on_afterwards(time: CellTime, clock: Clock) -> None:
    time.wake_at(110.0)
    clock.now = 104.0
    time.pause()
    clock.now = 200.0
    assert time.now == 104.0
    assert time.plant_now == 200.0
    assert time.next_deadline is None
    assert not time.woken()
    time.go_on()
    assert time.now == 104.0
    assert time.paused_s == 96.0
    assert time.next_deadline == 206.0
    clock.now = 205.9
    assert not time.woken()
    clock.now = 206.0
    assert time.woken()


def test_pauses_add_up(time: CellTime, clock: Clock) -> None:
    for _ in range(3):
        time.pause()
        clock.now += 5.0
        time.go_on()
        clock.now += 1.0
    assert time.paused_s == 15.0
    assert time.now == 103.0


def test_a_pause_may_have_begun_before_it_is_known(time: CellTime, clock: Clock) -> None:
    clock.now = 104.0
    time.pause(at=102.0)
    assert time.now == 102.0
    time.pause(at=103.0)
    assert time.now == 102.0, "it is paused already"
    time.go_on()
    assert time.now == 102.0


def test_going_on_without_a_pause_changes_nothing(time: CellTime, clock: Clock) -> None:
    time.go_on()
    assert (time.now, time.paused_s) == (clock.now, 0.0)


def test_a_wake_that_comes_while_held_is_due_afterwards(time: CellTime, clock: Clock) -> None:
    time.pause()
    time.wake_at(101.0)
    clock.now = 150.0
    assert time.next_deadline is None
    time.go_on()
    assert time.next_deadline == 151.0


def test_what_the_last_tree_waited_for_is_forgotten(time: CellTime, clock: Clock) -> None:
    time.wake_at(101.0)
    time.forget_wakes()
    clock.now = 101.0
    assert time.next_deadline is None
    assert not time.woken()


@pytest.mark.parametrize(("at", "held_s"), [(100.1, 0.7), (1e6 + 0.1, 1 / 3), (100.3, 1e5 + 0.1)])
def test_the_plant_never_wakes_an_instant_too_early(
    time: CellTime, clock: Clock, at: float, held_s: float
) -> None:
    time.pause()
    clock.now += held_s
    time.go_on()
    time.wake_at(at)
    assert time.next_deadline is not None
    clock.now = time.next_deadline
    assert time.woken()
