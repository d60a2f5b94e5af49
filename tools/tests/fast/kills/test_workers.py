"""Charges against a campaign whose workers were killed."""

from __future__ import annotations

from arboleda_kills.workers import Shared, differences

ALONE = {1: "a", 2: "b", 3: "c"}


def shared(digests: dict[int, str], times: dict[int, int]) -> Shared:
    return Shared(digests=digests, times=times, kills=1, seconds=1.0)


def test_seeds_that_were_done_once_and_came_to_the_same_are_right() -> None:
    assert differences(shared(ALONE, {1: 1, 2: 1, 3: 1}), ALONE) == []


def test_a_seed_that_was_done_twice_or_never_is_named() -> None:
    found = differences(shared(ALONE, {1: 1, 2: 2}), ALONE)
    assert found == ["seed 2 was done 2 times", "seed 3 was done 0 times"]


def test_a_seed_that_came_to_something_else_is_named() -> None:
    found = differences(shared({1: "a", 2: "x"}, {1: 1, 2: 1, 3: 1}), ALONE)
    assert found == ["seed 2: x by the workers, b alone", "seed 3: None by the workers, c alone"]
