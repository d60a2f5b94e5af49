"""Fewer faults that still break the same invariant (delta debugging: Zeller and Hildebrandt, 2002)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from .faults import Fault
from .run import MINUTE_S, Plan, Result

ATTEMPTS = 150  # runs at most
Attempt = Callable[[Plan, float], Result]  # a plan of faults and the seconds to run -> what happened
Progress = Callable[[int, int], None]  # (runs so far, faults that are left)


def explicit(faults: Iterable[Fault]) -> Plan:
    """A plan of exactly these faults."""
    by_minute: dict[int, list[Fault]] = {}
    for fault in faults:
        by_minute.setdefault(int(fault.at // MINUTE_S), []).append(fault)
    return lambda minute: by_minute.get(minute, [])


def shrink(broken: Result, attempt: Attempt, progress: Progress = lambda runs, left: None) -> Result:
    """The run with the fewest faults found that breaks as `broken` does; `broken` itself where none does.

    No single fault can be left out of the result, unless ATTEMPTS runs were not enough to find out.
    """
    return _Search(broken, attempt, progress).search()


class _Search:
    def __init__(self, broken: Result, attempt: Attempt, progress: Progress) -> None:
        self._best = broken
        self._attempt = attempt
        self._progress = progress
        self._runs = 0

    def search(self) -> Result:
        """Leave out ever smaller parts, as long as what remains still breaks."""
        if self._breaks([]):
            return self._best
        parts = 2
        while len(self._best.faults) > 1 and self._runs < ATTEMPTS:
            if self._leave_out_one_of(parts):
                parts = max(parts - 1, 2)
            elif parts >= len(self._best.faults):
                break
            else:
                parts = min(2 * parts, len(self._best.faults))
        return self._best

    def _leave_out_one_of(self, parts: int) -> bool:
        faults = self._best.faults
        size = -(-len(faults) // parts)
        starts = range(0, len(faults), size)
        return any(self._breaks(faults[:start] + faults[start + size :]) for start in starts)

    def _breaks(self, faults: Sequence[Fault]) -> bool:
        if self._runs >= ATTEMPTS or self._best.broken is None:
            return False
        self._runs += 1
        found = self._attempt(explicit(faults), self._best.minutes * MINUTE_S)
        same = found.broken is not None and found.broken.invariant == self._best.broken.invariant
        if same:
            self._best = found
        self._progress(self._runs, len(self._best.faults))
        return same
