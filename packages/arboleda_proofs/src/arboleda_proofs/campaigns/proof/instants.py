"""Instants that a run can tell apart: before and after each of its events, and the middle between two."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

US = 1e-6  # boards count in these
LONG_S = 0.02  # events further apart have a middle


class Side(str, Enum):
    """The side of an event on which an instant lies, or between two of them."""

    BEFORE = "just before"
    AFTER = "just after"
    BETWEEN = "in the middle after"


@dataclass(frozen=True, kw_only=True)
class Mark:
    """Event of a run, `at` s: a command that left, arrived or ended, or a word on the task.

    `begins`: a step begins with it. `commits`: so many commits and messages of the plant came with it.
    """

    at: float
    what: str
    begins: bool
    commits: int


@dataclass(frozen=True, kw_only=True)
class Instant:
    """Instant `at` s of a run, at the event `what`; `commits` are those that follow at once.

    `level` is its turn: beginnings of steps come first, then what lies between events, then all others.
    """

    at: float
    side: Side
    what: str
    commits: int = 0
    level: int = 0

    @property
    def name(self) -> str:
        """Its place in the run, for people."""
        return f"{self.side.value} {self.what} ({self.at:.3f} s)"


def instants(marks: Iterable[Mark]) -> list[Instant]:
    """All instants, in the order of time; of events at one time the first gives its name."""
    rows = _joined(sorted(marks, key=lambda mark: mark.at))
    found = [each for mark in rows for each in _around(mark)]
    return sorted([*found, *_between(rows)], key=lambda each: each.at)


def _joined(marks: Iterable[Mark]) -> list[Mark]:
    """The marks with those of one time as one."""
    rows: list[Mark] = []
    for mark in marks:
        if not rows or mark.at - rows[-1].at > 3 * US:
            rows.append(mark)
            continue
        last = rows.pop()
        first = mark if mark.begins and not last.begins else last
        begins = last.begins or mark.begins
        rows.append(Mark(at=last.at, what=first.what, begins=begins, commits=last.commits + mark.commits))
    return rows


def _around(mark: Mark) -> Iterator[Instant]:
    before, after = math.floor(mark.at / US) * US, (math.ceil(mark.at / US) + 1) * US
    level = 0 if mark.begins else 2
    yield Instant(at=round(before, 6), side=Side.BEFORE, what=mark.what, commits=mark.commits, level=level)
    yield Instant(at=round(after, 6), side=Side.AFTER, what=mark.what, level=2)


def _between(rows: Sequence[Mark]) -> Iterator[Instant]:
    for one, other in pairwise(rows):
        if other.at - one.at > LONG_S:
            middle = round((one.at + other.at) / 2, 6)
            yield Instant(at=middle, side=Side.BETWEEN, what=one.what, level=1)
