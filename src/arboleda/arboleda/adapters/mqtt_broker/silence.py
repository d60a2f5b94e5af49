"""Silence of a client of the broker, which ends its connection where it lasts too long."""

from __future__ import annotations

import asyncio
from collections.abc import Callable


class Silence:
    """Time since `last_data_at`; a client that is silent for too long is `cut` off."""

    def __init__(self, loop: asyncio.AbstractEventLoop, cut: Callable[[str], None]) -> None:
        self.last_data_at = loop.time()
        self._loop = loop
        self._cut = cut
        self._timer: asyncio.TimerHandle | None = None

    def watch(self, longest_s: float, then: Callable[[], None] | None = None) -> None:
        """Call `then`, or without it cut the client off, after a silence of `longest_s`; 0: never."""
        self.end()
        left = self.last_data_at + longest_s - self._loop.time()
        if longest_s == 0.0:
            return
        if left > 0:
            self._timer = self._loop.call_later(left, self.watch, longest_s, then)
        elif then is not None:
            then()
        else:
            self._cut("it was silent for too long")

    def end(self) -> None:
        """Watch no more."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
