"""The order of the tests where several workers share them: while one waits for a robot, another computes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TypeVar

T = TypeVar("T")


def dealt(waiting: Sequence[list[T]], computing: Sequence[T], workers: int) -> Iterator[T]:
    """A hand for each worker, as many tests in each: groups that wait, and between them tests that compute.

    xdist's worksteal gives the first worker the first part of the tests, and so on. A group stays together,
    for it may have a plant or a browser in common. Every second hand begins with tests that compute.
    """
    rest = iter(computing)
    size = -(-(sum(map(len, waiting)) + len(computing)) // workers)
    for number in range(workers):
        groups = waiting[number::workers]
        share = list(islice(rest, max(0, size - sum(map(len, groups)))))
        yield from _hand(groups or [[]], share, computes_first=number % 2 == 1)
    yield from rest


def _hand(groups: Sequence[list[T]], computing: Sequence[T], *, computes_first: bool) -> Iterator[T]:
    for number, group in enumerate(groups):
        begin, end = (n * len(computing) // len(groups) for n in (number, number + 1))
        between = computing[begin:end]
        yield from (*between, *group) if computes_first else (*group, *between)


def share(items: Sequence[T], number: int, workers: int) -> Sequence[T]:
    """The items of a worker, by its number from 0; those of all workers are all items in their order."""
    begin, end = (n * len(items) // workers for n in (number, number + 1))
    return items[begin:end]
