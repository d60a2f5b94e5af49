"""Flow of messages from one end to another: how many come through per second, and how long each takes."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import count, cycle
from typing import Any

from arboleda.extension import ArboledaError

from .scene import wait_for

WINDOW = 4  # messages of one source under way when saturated; a topic's queue holds 10
WARM_UP_S = 0.2
QUIET_S = 0.1  # without a message: nothing is under way any more
PUMP_S = 0.02
NUMBERS = 1000  # messages of one source are told apart by their number modulo this
Then = Callable[[str, Any], None]


class Flow:
    """One direction of a bridge, from each of `sources` to the other end.

    `send(source, number)` pushes one message in; messages that come out are handed to `arrive`, and
    `number_of` finds their numbers, modulo NUMBERS. `pump(seconds)` is called while nothing is to be sent,
    and for `wake_s` before each measurement.
    """

    def __init__(
        self,
        sources: Sequence[str],
        *,
        send: Callable[[str, int], None],
        pump: Callable[[float], object],
        number_of: Callable[[Any], int],
        wake_s: float = 0.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._sources = sources
        self._send = send
        self._pump = pump
        self._number_of = number_of
        self._wake_s = wake_s
        self._clock = clock
        self._numbers = count(1)
        self.sent = self.arrived = 0  # since the way is open
        self._then: Then = _nothing

    def arrive(self, source: str, message: Any) -> None:
        """Take in a message that has come out at the other end."""
        self._then(source, message)

    def open(self, check: Callable[[], None]) -> None:
        """Push until a message of every source has come out; raises ArboledaError if that takes too long."""
        silent = set(self._sources)
        self._then = lambda source, _: silent.discard(source)
        wait_for(lambda: self._knock(silent), "the way through the bridge", check)
        self._wait(QUIET_S)
        self._then = _nothing
        self.sent = self.arrived = 0

    def rate(self, seconds: float) -> float:
        """Messages per second, with WINDOW of every source always under way."""
        self._wait(self._wake_s)
        self._then = self._answer
        for source in [*self._sources] * WINDOW:
            self._push(source)
        self._wait(WARM_UP_S)
        before, begin = self.arrived, self._clock()
        self._wait(seconds)
        rate = (self.arrived - before) / (self._clock() - begin)
        self._then = self._count
        self._drain()
        if not rate:
            raise ArboledaError("nothing comes through the bridge any more")
        return rate

    def latencies(self, per_second: float, seconds: float) -> list[float]:
        """The seconds that each message took, with so many per second pushed in, whatever comes out."""
        pushed: dict[tuple[str, int], float] = {}
        took: list[float] = []

        def arrived(source: str, message: Any) -> None:
            now = self._clock()
            self.arrived += 1
            took.append(now - pushed[source, self._number_of(message)])

        self._wait(self._wake_s)
        self._then = arrived
        begin = self._clock()
        for turn, source in zip(range(int(per_second * seconds)), cycle(self._sources), strict=False):
            self._wait(begin + turn / per_second - self._clock())
            number = next(self._numbers)
            pushed[source, number % NUMBERS] = self._clock()
            self._push(source, number)
        self._drain()
        return took

    def _knock(self, silent: set[str]) -> bool:
        for source in tuple(silent):
            self._push(source)
        self._wait(PUMP_S)
        return not silent

    def _answer(self, source: str, _: Any) -> None:
        self.arrived += 1
        self._push(source)

    def _count(self, _source: str, _message: Any) -> None:
        self.arrived += 1

    def _push(self, source: str, number: int | None = None) -> None:
        self.sent += 1
        self._send(source, next(self._numbers) if number is None else number)

    def _drain(self) -> None:
        """Wait until nothing comes out any more."""
        before = -1
        while before != self.arrived:
            before = self.arrived
            self._wait(QUIET_S)
        self._then = _nothing

    def _wait(self, seconds: float) -> None:
        until = self._clock() + seconds
        while True:
            left = until - self._clock()
            self._pump(min(max(left, 0.0), PUMP_S))
            if left <= 0:
                return


def _nothing(source: str, message: Any) -> None: ...
