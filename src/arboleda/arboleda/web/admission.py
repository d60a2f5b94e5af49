"""Choice of the connection to close when there are too many; a crowd must never keep out a stop."""

from __future__ import annotations

from collections.abc import Collection
from itertools import count
from typing import Protocol


class Guest(Protocol):
    """A connection as the admission sees it."""

    number: int  # in the order they came; the clocks of event loops are too coarse for it

    @property
    def peer(self) -> str | None:
        """The address it comes from."""

    @property
    def waits(self) -> bool:
        """True while the client has to act: to ask, to send the rest of a body, or to read an answer."""

    @property
    def looks(self) -> bool:
        """True while the client waits for the answer to a request that only reads."""

    @property
    def known(self) -> bool:
        """True if the client showed a login with its last request."""


class Admission:
    """Counts the connections of one server: at most `most`, and of one address `per_peer`.

    Where one comes too many, the oldest that waits for its client is cut, one without login before one that
    has it; where none waits for its client, as the server is flooded, the oldest that only wants to look. The
    newcomer is not: it may be about to stop the plant, and what fills a server is old.
    """

    def __init__(self, most: int) -> None:
        self.most = most
        self.per_peer = most * 5 // 8  # twenty browsers behind one address, and room for everybody else
        self._numbers = count()

    def next_number(self) -> int:
        """The number of the next connection."""
        return next(self._numbers)

    def surplus(self, guests: Collection[Guest], others: int, newcomer: Guest) -> Guest | None:
        """The guest to disconnect for the newcomer, which is among `guests`; None if there is room.

        `others` is the number of connections that count but cannot be cut.
        """
        mine = [guest for guest in guests if guest.peer == newcomer.peer]
        if len(mine) > self.per_peer:
            return _oldest(mine, newcomer)
        return _oldest(guests, newcomer) if len(guests) + others > self.most else None


def _oldest(crowd: Collection[Guest], newcomer: Guest) -> Guest:
    waiting = [guest for guest in crowd if guest.waits and guest is not newcomer]
    strangers = [guest for guest in waiting if not guest.known]
    # Who has just come has had no time to show a login. Where it is the known ones that crowd, strangers
    # keep a quarter of the places, or newcomers would push each other out.
    those = strangers if 4 * len(strangers) >= len(crowd) else waiting
    those = those or [guest for guest in crowd if guest.looks and guest is not newcomer]
    return min(those, key=lambda guest: guest.number, default=newcomer)
