"""The clock of a running plant."""

from __future__ import annotations

import time
from collections.abc import Callable

BOOT = getattr(time, "CLOCK_BOOTTIME", None)  # Linux
SET_S = 1.0  # a clock that nobody sets strays by less
TOGETHER_S = 0.1  # two clocks that are read further apart say nothing about each other


def seconds() -> float:
    """Seconds that never go back; they pass while the machine is suspended, where the system counts that.

    Linux does, by CLOCK_BOOTTIME; `time.monotonic` stands still there until the machine wakes up.
    """
    return time.monotonic() if BOOT is None else time.clock_gettime(BOOT)


class Calendar:
    """Unix time that passes as `seconds` does: between two times its difference is what has passed.

    It follows the wall clock once `look` finds that this was set.
    """

    def __init__(self, wall: Callable[[], float] = time.time, steady: Callable[[], float] = seconds) -> None:
        self._wall = wall
        self._steady = steady
        self._zero_s = wall() - steady()

    def unix_s(self) -> float:
        """The time of day, s of Unix time."""
        return self._zero_s + self._steady()

    def look(self) -> float:
        """The seconds by which the wall clock was set since the last look, 0 where it was not."""
        before_s = self._steady()
        by_s = self._wall() - self._zero_s - before_s
        if abs(by_s) < SET_S or self._steady() - before_s > TOGETHER_S:
            return 0.0
        self._zero_s += by_s
        return by_s
