"""A thread that does things when their time has come: how long a robot's move takes."""

from __future__ import annotations

import heapq
import threading
import time
from collections.abc import Callable
from itertools import count

now = time.perf_counter


class Clockwork:
    """Calls what it was given, each at its time and in one thread of its own, between `start` and `stop`."""

    def __init__(self) -> None:
        self._due: list[tuple[float, int, Callable[[], None]]] = []
        self._number = count()
        self._awake = threading.Condition()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="clockwork", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def after(self, seconds: float, act: Callable[[], None]) -> None:
        """Call `act` that many seconds from now; from any thread."""
        with self._awake:
            heapq.heappush(self._due, (now() + seconds, next(self._number), act))
            self._awake.notify()

    def every(self, seconds: float, act: Callable[[], None]) -> None:
        """Call `act` again and again, first after the first period."""

        def again() -> None:
            act()
            self.after(seconds, again)

        self.after(seconds, again)

    def stop(self) -> None:
        """End; what is not yet due is forgotten. Idempotent."""
        with self._awake:
            self._ending = True
            self._awake.notify()
        if self._thread.ident is not None:
            self._thread.join()

    def _run(self) -> None:
        while (act := self._next()) is not None:
            act()

    def _next(self) -> Callable[[], None] | None:
        """The next one, at its time; None at the end."""
        with self._awake:
            while not self._ending:
                wait_s = self._due[0][0] - now() if self._due else None
                if wait_s is not None and wait_s <= 0:
                    return heapq.heappop(self._due)[2]
                self._awake.wait(wait_s)
            return None
