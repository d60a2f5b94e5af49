"""Leader of a plant as others see it: a waiting standby, or somebody who asks for a planned change."""

from __future__ import annotations

import os
import socket
from typing import Any

from arboleda.adapters import clock
from arboleda.departures.leading import LEASE_S, Silence
from arboleda.drivers import plain
from arboleda.extension import ArboledaError, StartError
from arboleda.store.leadership import Leader, Leadership

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


class PostgresLeadership(Leadership):
    """Leadership in a database: a connection of its own."""

    def __init__(self, address: str, plant: str) -> None:
        self.name = f"{address} ({plant})"
        self._address = checked(address)
        self._schema = schema_of(plant)
        self._me = (plain(socket.gethostname()), os.getpid())
        self._opened: Impatient | None = None
        self._silence = Silence()

    def prepare(self) -> None:
        """Make the plant's schema and tables; raises StartError if that is impossible."""
        with explained(self.name, StartError):
            prepare(self._connection(), self._schema, self.name)

    def leader(self) -> Leader:
        (row,) = self._query(LEADER, LEASE_S, LEASE_S)
        epoch, host, process, url, leads, standbys = row
        return Leader(
            epoch=epoch, host=plain(host), process=process, url=plain(url), leads=leads, standbys=standbys
        )

    def is_free(self) -> bool:
        """The same; ends the lease of a leader that was silent for the length of it."""
        (row,) = self._query(LAST_SEEN)
        if row[1] is None:
            return True
        return self._silence.ends_lease(clock.seconds(), row) and bool(self._query(END_LEASE, *row))

    def wait_here(self, url: str = "") -> None:
        self._query(WAITS, *self._me, url)

    def own_address(self) -> str:
        with explained(self.name, ArboledaError, "cannot be reached"):
            return own_address(self._connection())

    def wait_no_more(self) -> None:
        self._query("DELETE FROM standby WHERE host = %s AND process = %s", *self._me)

    def ask_for_handover(self) -> None:
        self._query("UPDATE leader SET wanted = clock_timestamp()")

    def close(self) -> None:
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def _query(self, statement: str, *values: object) -> list[tuple[Any, ...]]:
        with explained(self.name, ArboledaError, "cannot be reached"):
            cursor = self._connection().execute(statement, values)
            return cursor.fetchall() if cursor.description else []

    def _connection(self) -> Impatient:
        if self._opened is None or self._opened.closed:
            self._opened = connected(self._address, self._schema)
        return self._opened
