"""How much of the broker one client may have, so that no client can take it from the others."""

from __future__ import annotations

from dataclasses import dataclass

PACKET_BYTES = 4096  # the longest message of a board has a few hundred
TOPIC_BYTES = 256
CLIENT_ID_BYTES = 128
HELLO_S = 5.0  # an open connection has this long to log in
REFUSED_S = 0.2  # before a wrong login is answered: guessing passwords takes time
WAITING = 32  # connections that have not logged in, at most
FILTERS = 16384  # subscriptions of all users together
WILDCARDS = 256  # those of them with + or #, which every message is held against
WILDCARD_COST = 20  # messages: a newcomer's wildcard is held against every retained message
UNSENT_BYTES = 512_000  # what waits for a client that reads too slowly
UNACKNOWLEDGED = 4096  # messages that a client has not said to have received
RETAINED_BYTES = 256_000  # all retained messages, so that every client can be sent all of them at once
TURN_S = 0.002  # for the packets of one client before it is the others' turn


@dataclass(frozen=True, kw_only=True)
class Allowance:
    """What one user may have: messages a second (and as many at once), connections, and subscriptions of each
    connection, those with wildcards among them."""

    rate: float
    connections: int
    filters: int
    wildcards: int


class Bucket:
    """Counts what is used; `rate` comes back each second, up to a second's worth."""

    def __init__(self, rate: float, now: float) -> None:
        self._rate = rate
        self._left = rate
        self._at = now

    def take(self, count: float, now: float) -> float:
        """Use `count`; for how many seconds there will be none then, 0.0 where some are left."""
        self._left = min(self._rate, self._left + (now - self._at) * self._rate) - count
        self._at = now
        return max(0.0, -self._left / self._rate)
