"""Limits of each client of the broker, so that no client can use up the share of the others."""

from __future__ import annotations

from dataclasses import dataclass

PACKET_BYTES = 4096  # the longest message of a board has a few hundred
TOPIC_BYTES = 256
CLIENT_ID_BYTES = 128
HELLO_S = 5.0  # an open connection has this long to log in
REFUSED_S = 0.2  # delay of the answer to a wrong login, so that guessing passwords takes time
WAITING = 32  # connections that have not logged in, at most
FILTERS = 16384  # subscriptions of all users together
WILDCARDS = 256  # those with + or #, which every message is compared with
WILDCARD_COST = 20  # messages; a new wildcard is compared with every one of them
UNSENT_BYTES = 512_000  # limit of data that waits for a slow client
UNACKNOWLEDGED = 4096  # messages that a client has not acknowledged
RETAINED_BYTES = 256_000  # all retained messages, so that every client can be sent all of them at once
TURN_S = 0.002  # time for the packets of one client before the others' turn


@dataclass(frozen=True, kw_only=True)
class Allowance:
    """Limits of one user: messages a second, connections, and subscriptions per connection.

    `rate` is also the number of messages that may come at once; `wildcards` counts within `filters`.
    """

    rate: float
    connections: int
    filters: int
    wildcards: int


class Bucket:
    """Token bucket: `rate` tokens come back each second, up to a second's worth."""

    def __init__(self, rate: float, now: float) -> None:
        self._rate = rate
        self._left = rate
        self._at = now

    def take(self, count: float, now: float) -> float:
        """Use `count` tokens; returns the seconds until there are any again, 0.0 if some are left."""
        self._left = min(self._rate, self._left + (now - self._at) * self._rate) - count
        self._at = now
        return max(0.0, -self._left / self._rate)
