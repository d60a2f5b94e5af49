"""Logins of the broker, and the topics that each role may write and read."""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from arboleda.wire.topics import Channel, topic

from .limits import Allowance

BOARDS_WRITE = (Channel.TELEMETRY, Channel.PRESENCE)


class Role(Enum):
    """Role of a client: the plant itself, a board, somebody who only reads, or a guest."""

    PLANT = "plant"
    BOARD = "board"
    READER = "reader"
    GUEST = "guest"  # on this machine, where nobody needs a password


ALLOWED = {
    # A board's telemetry comes ten times a second.
    Role.BOARD: Allowance(rate=200.0, connections=16, filters=64, wildcards=4),
    Role.READER: Allowance(rate=200.0, connections=16, filters=64, wildcards=16),
    # The bridge of a plant of 300 cells in a process of its own is a guest.
    Role.GUEST: Allowance(rate=2000.0, connections=1024, filters=2048, wildcards=16),
}


@dataclass(frozen=True, kw_only=True)
class ClientIdentity:
    """A client that is logged in. A client id belongs to its user: another's is another id."""

    role: Role
    user: str = ""


@dataclass(frozen=True, kw_only=True)
class Access:
    """The plant itself does everything; a board writes its own telemetry and presence and reads its own
    topics; any other user reads everything and writes nothing. With `guests` nobody needs a password, and
    all do everything. Where they are `certified`, boards and readers show a certificate with their name."""

    plant: tuple[str, str]  # user and password
    passwords: Mapping[str, str]
    boards: frozenset[str]
    guests: bool
    certified: bool = False

    def login(self, user: str | None, password: bytes | None, shown: str = "") -> ClientIdentity | None:
        """The user behind these credentials; None for a stranger.

        `shown` is the name in the client's certificate; where `certified` is set, it must be the name of the
        user.
        """
        secret = password or b""
        if user == self.plant[0] and hmac.compare_digest(self.plant[1].encode(), secret):
            return ClientIdentity(role=Role.PLANT, user=user)
        if self.guests:
            return ClientIdentity(role=Role.GUEST)
        expected = self.passwords.get(user) if user is not None else None
        if user is None or expected is None or not hmac.compare_digest(expected.encode(), secret):
            return None
        if self.certified and shown != user:
            return None
        return ClientIdentity(role=Role.BOARD if user in self.boards else Role.READER, user=user)

    def may_write(self, who: ClientIdentity, name: str) -> bool:
        """True if `who` may publish to the topic `name`; the same holds for a last will."""
        if who.role is Role.BOARD:
            return name in {topic(who.user, channel) for channel in BOARDS_WRITE}
        return who.role is not Role.READER

    def may_read(self, who: ClientIdentity, pattern: str) -> bool:
        """True if `who` may subscribe to the filter `pattern`."""
        return who.role is not Role.BOARD or pattern.split("/")[0] == who.user
