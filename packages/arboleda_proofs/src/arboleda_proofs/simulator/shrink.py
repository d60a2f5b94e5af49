"""Fewer faults that still break the same invariant (after Zeller and Hildebrandt, Delta debugging, 2002)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from .faults import Fault
from .run import MINUTE_S, Plan, Result

ATTEMPTS = 150  # runs at most
Attempts = Callable[[Result, Sequence[Sequence[Fault]]], Iterator[Result]]
"""(the best so far, lists of faults that may break as it does) -> a run of each list, in this order"""
Progress = Callable[[int, Result], None]  # (runs so far, the best of them)


def explicit(faults: Iterable[Fault]) -> Plan:
    """A plan of exactly these faults."""
    by_minute: dict[int, list[Fault]] = {}
    for fault in faults:
        by_minute.setdefault(int(fault.at // MINUTE_S), []).append(fault)
    return lambda minute: by_minute.get(minute, [])


def shrink(broken: Result, attempts: Attempts, progress: Progress = lambda runs, best: None) -> Result:
    """The run with the fewest faults found that breaks as `broken` does; `broken` itself where none does.

    No single fault can be left out of the result, unless ATTEMPTS runs were not enough to find out.
    """
    return _Search(broken, attempts, progress).search()


def breaks_alike(one: Result, other: Result) -> bool:
    """True if both runs break, and the same invariant."""
    return bool(one.broken and other.broken and one.broken.invariant == other.broken.invariant)


class _Search:
    def __init__(self, broken: Result, attempts: Attempts, progress: Progress) -> None:
        self._best = broken
        self._attempts = attempts
        self._progress = progress
        self._runs = 0
        self._tried: set[tuple[Fault, ...]] = set()

    def search(self) -> Result:
        """Leave out everything, else ever smaller parts, and single faults again until none can go."""
        size = len(self._best.faults)
        while size and (self._leave_out(size) or size > 1):
            size = min(-(-size // 2), len(self._best.faults))
        return self._best

    def _leave_out(self, size: int) -> bool:
        """Leave out each part of so many faults that is not needed; True if any could go."""
        at, could_go = 0, False
        while at < len(self._best.faults):
            starts = range(at, len(self._best.faults), size)
            number = self._first_not_needed(starts, size)
            if number is None:
                break
            at, could_go = starts[number], True
        return could_go

    def _first_not_needed(self, starts: Sequence[int], size: int) -> int | None:
        faults = self._best.faults
        rests = {number: (*faults[:at], *faults[at + size :]) for number, at in enumerate(starts)}
        untried = [number for number, rest in rests.items() if rest not in self._tried]
        untried = untried[: ATTEMPTS - self._runs]
        if not untried:
            return None
        results = self._attempts(self._best, [rests[number] for number in untried])
        for number, result in zip(untried, results, strict=True):
            self._tried.add(rests[number])
            self._runs += 1
            alike = breaks_alike(result, self._best)
            self._best = result if alike else self._best
            self._progress(self._runs, self._best)
            if alike:
                return number
        return None
