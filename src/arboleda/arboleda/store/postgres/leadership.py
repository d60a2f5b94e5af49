"""Who leads a plant, as others see it: a standby that waits, and whoever asks for a planned change."""

from __future__ import annotations

import os
import socket
from dataclasses import dataclass
from typing import Any

from arboleda.adapters import clock
from arboleda.core.leading import LEASE_S, Silence
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.outside import plain

from .leader_row import END_LEASE, LAST_SEEN, lately
from .schema import prepare, schema_of
from .server import Impatient, checked, connected, explained, own_address

LEADER = (
    f"SELECT epoch, host, process, url, {lately('seen')},"
    f" (SELECT count(*) FROM standby WHERE {lately('seen')}) FROM leader"
)
WAITS = (
    "INSERT INTO standby (host, process, url, seen) VALUES (%s, %s, %s, clock_timestamp())"
    " ON CONFLICT (host, process) DO UPDATE SET url = excluded.url, seen = excluded.seen"
)


@dataclass(frozen=True, kw_only=True)
class Leader:
    """Who led the plant last; `leads` where he has said so lately, by the clock of the database, by which
    nobody takes a plant over. `url` is his page, "" where he has said none; `standbys` is how many wait for
    him to end."""

    epoch: int
    host: str
    process: int
    url: str
    leads: bool
    standbys: int


class Leadership:
    """On a connection of its own, for one thread at a time; ArboledaError where the database is away."""

    def __init__(self, address: str, plant: str) -> None:
        self.name = f"{address} ({plant})"
        self._address = checked(address)
        self._schema = schema_of(plant)
        self._me = (plain(socket.gethostname()), os.getpid())
        self._opened: Impatient | None = None
        self._silence = Silence()

    def prepare(self) -> None:
        """Make what a plant has there; StartError says why that cannot be."""
        with explained(self.name, StartError):
            prepare(self._connection(), self._schema, self.name)

    def leader(self) -> Leader:
        (row,) = self._asked(LEADER, LEASE_S, LEASE_S)
        epoch, host, process, url, leads, standbys = row
        return Leader(
            epoch=epoch, host=plain(host), process=process, url=plain(url), leads=leads, standbys=standbys
        )

    def is_free(self) -> bool:
        """Whether nobody leads: who did gave the plant back, or was silent for the length of a lease, which
        is ended then. Ask again and again: that time is counted here."""
        (seen,) = self._asked(LAST_SEEN)
        if seen[1] is None:
            return True
        return self._silence.ends_lease(clock.seconds(), seen) and bool(self._asked(END_LEASE, *seen))

    def wait_here(self, url: str = "") -> None:
        """Say that this process waits to lead, and where its page is."""
        self._asked(WAITS, *self._me, url)

    def own_address(self) -> str:
        """By which address hosts that reach the database may reach this one, "" where that is not known."""
        with explained(self.name, ArboledaError, "cannot be reached"):
            return own_address(self._connection())

    def wait_no_more(self) -> None:
        self._asked("DELETE FROM standby WHERE host = %s AND process = %s", *self._me)

    def ask_for_handover(self) -> None:
        """Have the leader hold what is at work, and give the plant to who waits."""
        self._asked("UPDATE leader SET wanted = clock_timestamp()")

    def close(self) -> None:
        """Give the connection back; idempotent."""
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def _asked(self, statement: str, *values: object) -> list[tuple[Any, ...]]:
        with explained(self.name, ArboledaError, "cannot be reached"):
            cursor = self._connection().execute(statement, values)
            return cursor.fetchall() if cursor.description else []

    def _connection(self) -> Impatient:
        if self._opened is None or self._opened.closed:
            self._opened = connected(self._address, self._schema)
        return self._opened
