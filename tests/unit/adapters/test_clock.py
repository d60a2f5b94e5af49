"""The plant's clock."""

from __future__ import annotations

import time

import pytest

from arboleda.adapters import clock


@pytest.mark.skipif(not hasattr(time, "CLOCK_BOOTTIME"), reason="only Linux has this clock")
def test_it_counts_the_time_in_which_the_machine_is_suspended(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    monkeypatch.setattr(time, "clock_gettime", lambda which: read.append(which) or 7.5)
    assert clock.seconds() == 7.5
    assert read == [time.CLOCK_BOOTTIME]


def test_it_never_goes_back() -> None:
    assert clock.seconds() <= clock.seconds()


def test_elsewhere_it_is_the_monotonic_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "BOOT", None)
    monkeypatch.setattr(time, "monotonic", lambda: 3.0)
    assert clock.seconds() == 3.0


class Clocks:
    def __init__(self) -> None:
        self.steady_s, self.ahead_s = 100.0, 1e9
        self.calendar = clock.Calendar(lambda: self.steady_s + self.ahead_s, self.steady)

    def steady(self) -> float:
        return self.steady_s


def test_a_calendar_follows_a_clock_that_is_set_once_it_looks() -> None:
    clocks = Clocks()
    clocks.steady_s += 5.0
    assert clocks.calendar.look() == 0.0 and clocks.calendar.unix_s() == 1e9 + 105.0
    clocks.ahead_s -= 3600.0
    assert clocks.calendar.unix_s() == 1e9 + 105.0
    assert clocks.calendar.look() == -3600.0 and clocks.calendar.look() == 0.0
    assert clocks.calendar.unix_s() == 1e9 + 105.0 - 3600.0


def test_a_clock_that_strays_a_little_was_not_set() -> None:
    clocks = Clocks()
    clocks.ahead_s += 0.9
    assert clocks.calendar.look() == 0.0 and clocks.calendar.unix_s() == 1e9 + 100.0


def test_clocks_that_are_read_far_apart_say_nothing() -> None:
    steady = iter((0.0, 1.0, 9.0, 10.0, 10.0))
    wall = iter((1000.0, 1009.0, 1012.0))
    calendar = clock.Calendar(lambda: next(wall), lambda: next(steady))
    assert [calendar.look(), calendar.look()] == [0.0, 2.0]
