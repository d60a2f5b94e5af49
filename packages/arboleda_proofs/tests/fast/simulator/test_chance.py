"""Dice: the same draws for the same seed, on every machine and every Python."""

from __future__ import annotations

import pytest

from arboleda_proofs.simulator.chance import Dice


def test_a_seed_draws_what_it_always_drew():
    dice = Dice(4711, "faults", 0)
    assert [dice.random() for _ in range(3)] == GOLDEN
    assert [dice.below(10) for _ in range(10)] == GOLDEN_DIGITS


@pytest.mark.parametrize("other", [Dice(4712, "faults", 0), Dice(4711, "faults", 1), Dice(4711)])
def test_another_seed_or_name_draws_something_else(other):
    assert [other.random() for _ in range(3)] != GOLDEN


def test_streams_do_not_depend_on_each_other():
    alone, beside = Dice(1, "a"), Dice(1, "a")
    other = Dice(1, "b")
    for _ in range(5):
        assert alone.random() == beside.random()
        other.random()


def test_draws_stay_within_what_was_asked():
    dice = Dice(1)
    assert all(-2.0 <= dice.between(-2.0, 3.0) < 3.0 for _ in range(1000))
    assert {dice.below(4) for _ in range(1000)} == {0, 1, 2, 3}
    assert {dice.pick("abc") for _ in range(1000)} == {"a", "b", "c"}


@pytest.mark.parametrize(("probability", "expected"), [(0.0, 0), (1.0, 1000)])
def test_what_is_certain_happens_and_what_is_impossible_does_not(probability, expected):
    dice = Dice(1)
    assert sum(dice.chance(probability) for _ in range(1000)) == expected


GOLDEN = [0.11198347537328457, 0.6916715328978457, 0.3408116661788725]
GOLDEN_DIGITS = [0, 7, 5, 3, 5, 1, 7, 5, 8, 6]
