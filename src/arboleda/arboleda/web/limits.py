"""Limits of the HTTP server: sizes, rates, and numbers of connections."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable

from arboleda.client.protocol import BEAT_S as BEAT_S

API_BODY_BYTES = 4096
PAGE_BODY_BYTES = 65536
HEADER_BYTES = 16384
MESSAGE_BYTES = 65536  # of a websocket
BODY_S = 10.0
LATER_S = "10"  # Retry-After of answers to full limits

READ = (50.0, 400)  # per second, at once
PAGE = (300.0, 6000)  # one page is a hundred small files, and twenty browsers may sit behind one address
OPEN = (2.0, 40)  # a page itself, the largest of all answers
CHANGE = (10.0, 50)
HOLD = (40.0, 80)  # a button that is held, said again every 50 ms
GUESS = (0.1, 5)
MESSAGE = (50.0, 200)

CONNECTIONS = 300  # of one server; a plant says how many its limit of open files allows
SOCKETS = 64
STREAMS = 64


def lasting(most: int, connections: int) -> int:
    """The limit for connections of a kind that stay open: `most`, and at most a quarter of `connections`."""
    return max(1, min(most, connections // 4))


class Buckets:
    """One token bucket per client: `burst` at once, then `per_s`; the `most` last seen are remembered."""

    def __init__(
        self, rate: tuple[float, int], clock: Callable[[], float] = time.monotonic, *, most: int = 4096
    ) -> None:
        self._per_s, self._burst = rate
        self._clock = clock
        self._most = most
        self._levels: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, key: str) -> bool:
        """Count one request of the client; False if it has none left."""
        level = self._level(key)
        if level < 1:
            return False
        self._put(key, level - 1)
        return True

    def empty(self, key: str) -> bool:
        """True if `take` would return False."""
        return self._level(key) < 1

    def delay_s(self, key: str) -> float:
        """Count one request, and return the seconds to wait until it is within the rate."""
        level = self._level(key) - 1
        self._put(key, level)
        return max(0.0, -level / self._per_s)

    def _level(self, key: str) -> float:
        level, at = self._levels.get(key, (float(self._burst), self._clock()))
        return min(float(self._burst), level + (self._clock() - at) * self._per_s)

    def _put(self, key: str, level: float) -> None:
        self._levels[key] = (level, self._clock())
        self._levels.move_to_end(key)
        while len(self._levels) > self._most:
            self._levels.popitem(last=False)
