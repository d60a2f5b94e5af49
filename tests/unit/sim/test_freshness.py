"""Which telemetry a board counts as told lately."""

from __future__ import annotations

import pytest

from arboleda.sim.freshness import FRESH_US, MARK_US, Freshness

PERIOD_US = 100_000


def telling(seconds: float) -> tuple[Freshness, int]:
    """A board that has told ten times a second, and the number of its last telemetry."""
    freshness, count = Freshness(), round(seconds * 10)
    for number in range(1, count + 1):
        freshness.tell(number * PERIOD_US, number)
    return freshness, count


def test_what_was_told_within_two_seconds_is_covered_but_for_a_quarter_of_one() -> None:
    freshness, last = telling(60.0)
    now_us = last * PERIOD_US
    for number in range(1, last + 1):
        age_us = now_us - number * PERIOD_US
        if age_us <= FRESH_US - MARK_US:
            assert freshness.covers(now_us, number)
        elif age_us > FRESH_US:
            assert not freshness.covers(now_us, number)


@pytest.mark.parametrize("seconds", [0.1, 0.3, 1.0])
def test_a_board_that_has_just_booted_covers_all_that_it_told_and_nothing_before(seconds: float) -> None:
    freshness, last = telling(seconds)
    assert all(freshness.covers(last * PERIOD_US, number) for number in range(1, last + 1))
    assert not freshness.covers(last * PERIOD_US, last + 1)
    assert not freshness.covers(last * PERIOD_US, 0)


def test_what_it_told_grows_old_while_it_says_nothing() -> None:
    freshness, last = telling(5.0)
    now_us = last * PERIOD_US
    assert freshness.covers(now_us + FRESH_US - MARK_US, last)
    assert not freshness.covers(now_us + FRESH_US + 1, last)


def test_who_never_told_anything_covers_nothing() -> None:
    assert not Freshness().covers(0, 0)
