"""Clockwork: calls functions at their times, as for the end of a robot's move and for its reports."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from heapq import heappop, heappush
from itertools import count


def now() -> float:
    """The time on the plant's clock, s."""
    return time.monotonic()


class Clockwork:
    """Calls each given function at its time, in one thread of its own between `start` and `stop`."""

    def __init__(self) -> None:
        self._due: list[tuple[float, int, Callable[[], None]]] = []
        self._number = count()
        self._awake = threading.Condition()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="clockwork", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def at(self, due: float, act: Callable[[], None]) -> None:
        """Call `act` at that time; from any thread."""
        with self._awake:
            entry = (due, next(self._number), act)
            heappush(self._due, entry)
            if self._due[0] is entry:
                self._awake.notify()

    def after(self, seconds: float, act: Callable[[], None]) -> None:
        """Call `act` that many seconds from now; from any thread."""
        self.at(now() + seconds, act)

    def every(self, seconds: float, act: Callable[[], None], *, first: float | None = None) -> None:
        """Call `act` again and again, from `first` on or after the first period."""
        due = now() + seconds if first is None else first

        def again() -> None:
            self.every(seconds, act, first=due + seconds)
            act()

        self.at(due, again)

    def do_one(self) -> bool:
        """Do the one thing that has been due for longest; False if nothing is due."""
        with self._awake:
            if not self._due or self._due[0][0] > now():
                return False
            act = heappop(self._due)[2]
        act()
        return True

    def stop(self) -> None:
        """End; what is not yet due is dropped. May be called twice."""
        with self._awake:
            self._ending = True
            self._awake.notify()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        while not self._ending:
            if not self.do_one():
                self._rest()

    def _rest(self) -> None:
        """Sleep until something is due."""
        with self._awake:
            left = self._due[0][0] - now() if self._due else None
            if not self._ending and (left is None or left > 0):
                self._awake.wait(left)
