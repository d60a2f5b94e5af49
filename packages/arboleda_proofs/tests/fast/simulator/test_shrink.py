"""Shrinking with runs that are made up: they break while all needed faults are there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest

from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.judged_world import BrokenInvariant
from arboleda_proofs.simulator.run import Result
from arboleda_proofs.simulator.shrink import ATTEMPTS, shrink

FAULTS = [Fault(kind="mute", at=float(second)) for second in range(60)]


class Runs:
    """Runs that break with all faults at `needed` s, and something else with the fault at `other` s."""

    def __init__(self, needed: set[int], other: int | None = None) -> None:
        self.needed, self.other = needed, other
        self.lists: list[list[Fault]] = []
        self.asked = 0

    def of(self, faults: Sequence[Fault]) -> Result:
        there = {int(fault.at) for fault in faults}
        result = Result(seed=1, minutes=1, faults=list(faults))
        if self.needed <= there:
            result.broken = BrokenInvariant("one", "is broken")
        elif self.other in there:
            result.broken = BrokenInvariant("another", "is broken")
        return result

    def __call__(self, best: Result, lists: Sequence[Sequence[Fault]]) -> Iterator[Result]:
        for faults in lists:
            self.lists.append(list(faults))
            yield self.of(faults)

    def shrunk(self) -> list[int]:
        return [int(fault.at) for fault in shrink(self.of(FAULTS), self).faults]


@pytest.mark.parametrize("needed", [set(), {0}, {59}, {7, 8}, {3, 30, 41}, {1, 11, 21, 31, 41, 51}])
def test_only_the_needed_faults_are_left(needed: set[int]) -> None:
    runs = Runs(needed)
    assert runs.shrunk() == sorted(needed)
    assert len(runs.lists) == len({tuple(each) for each in runs.lists}), "none is run twice"


def test_large_parts_go_first() -> None:
    runs = Runs({3, 30, 41})
    assert len(runs.shrunk()) == 3
    assert [len(each) for each in runs.lists[:3]] == [0, 30, 30]
    assert len(runs.lists) < 40


def test_a_run_that_breaks_something_else_does_not_count() -> None:
    assert Runs({7, 8}, other=20).shrunk() == [7, 8]


def test_after_so_many_runs_it_ends_with_what_it_has() -> None:
    needed = set(range(0, 60, 2))
    runs = Runs(needed)
    assert needed <= set(runs.shrunk())
    assert len(runs.lists) <= ATTEMPTS


def test_the_best_so_far_is_told_after_every_run() -> None:
    runs, told = Runs({7, 8}), list[tuple[int, int]]()
    shrink(runs.of(FAULTS), runs, lambda number, best: told.append((number, len(best.faults))))
    assert [number for number, _ in told] == list(range(1, len(runs.lists) + 1))
    assert told[0] == (1, 60) and told[-1][1] == 2
    assert [left for _, left in told] == sorted((left for _, left in told), reverse=True)
