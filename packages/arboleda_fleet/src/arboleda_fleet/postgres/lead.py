"""The lead of a plant whose memory is in PostgreSQL: a lease that its leader renews."""

from __future__ import annotations

import json
import os
import socket
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, NoReturn

import psycopg

from arboleda.adapters import clock
from arboleda.departures.leading import LEASE_S, RENEW_S, WANTED_S, Lease, Silence
from arboleda.drivers import plain
from arboleda.extension import ArboledaError, StartError
from arboleda.store.lead import Lead, OtherLeader, Standby, Superseded

from .leader_row import END_LEASE, LAST_SEEN, lately
from .server import Impatient, explained, own_address
from .session import Session

PAUSE_S = 0.1
LEAD = (
    "UPDATE leader SET epoch = greatest(epoch + 1, %s), host = %s, process = %s, seen = clock_timestamp(),"
    " url = '', wanted = NULL,"
    # work goes on without a person only if the change of leader was requested just now
    f" going = CASE WHEN {lately('wanted')} THEN going ELSE '[]' END"
    " WHERE seen IS NULL RETURNING epoch, going"
)
RENEW = (
    "UPDATE leader SET seen = clock_timestamp() WHERE epoch = %s AND seen IS NOT NULL"
    f" RETURNING {lately('wanted')},"
    " (SELECT coalesce(json_agg(json_build_array(host, url) ORDER BY host, process), '[]') FROM standby"
    f" WHERE {lately('seen')})"
)


class PostgresLead(Lead):
    """The lead in the database of a session; `epoch` is its number, None before `take`."""

    renew_s = RENEW_S

    def __init__(self, session: Session) -> None:
        self.epoch: int | None = None
        self._session = session
        self._renewing: Impatient | None = None  # of the thread that renews
        self._lease = Lease()

    @property
    def is_certain(self) -> bool:
        return self._lease.lasts(clock.seconds())

    def take(self, epoch: int) -> int:
        """Take the lead, as in every memory; a killed leader is waited for as long as its lease lasts."""
        silence, first = Silence(), self._lease_row()
        while True:
            sent_at = clock.seconds()
            me = plain(socket.gethostname()), os.getpid()
            row = self._query(LEAD, epoch, *me, WANTED_S)
            if row is not None:
                self.epoch = int(row[0])
                self._lease.renewed(sent_at)
                self.going = tuple(json.loads(row[1]))
                self._query("UPDATE leader SET going = '[]' WHERE epoch = %s RETURNING epoch", self.epoch)
                return self.epoch
            lease = self._lease_row()
            if lease != first and lease[1] is not None:
                self._refuse_second()
            if silence.ends_lease(clock.seconds(), lease):
                self._query(END_LEASE, *lease)
            else:
                time.sleep(PAUSE_S)

    def give_up(self) -> None:
        """Give up the lead at once, if the server can be reached, so that no standby waits; idempotent."""
        if self.epoch is not None:
            with suppress(psycopg.Error, StartError):  # the lease ends by itself
                self._session.current().execute(
                    "UPDATE leader SET seen = NULL WHERE epoch = %s", (self.epoch,)
                )
        self.epoch = None
        if self._renewing is not None:
            self._renewing.close()
            self._renewing = None

    def renew(self) -> bool:
        if self._renewing is None or self._renewing.closed:
            with explained(self._session.name, ArboledaError, "cannot be reached"):
                self._renewing = self._session.another()
        return self.renew_by(self._renewing)

    def own_address(self) -> str:
        with (
            explained(self._session.name, ArboledaError, "cannot be reached"),
            self._session.another() as db,
        ):
            return own_address(db)

    def announce(self, url: str) -> None:
        self._session.beside("UPDATE leader SET url = %s WHERE epoch = %s", url, self.epoch)

    def hand_over(self, going: Sequence[str]) -> None:
        cells = json.dumps(list(going))
        self._session.beside("UPDATE leader SET going = %s WHERE epoch = %s", cells, self.epoch)

    def renew_by(self, db: Impatient) -> bool:
        """Renew the lease; True if another process is wanted as the leader."""
        sent_at = clock.seconds()
        with explained(self._session.name, ArboledaError, "cannot be reached"):
            row = db.execute(RENEW, (self.epoch, WANTED_S, LEASE_S)).fetchone()
        if row is None:
            raise self.superseded(db)
        self._lease.renewed(sent_at)
        self.standbys = tuple(Standby(host=plain(host), url=plain(url)) for host, url in row[1])
        return bool(row[0])

    def superseded(self, db: Impatient) -> Superseded:
        """The error for a process that leads no more."""
        return Superseded(
            f"Another process leads the plant of {self._session.name} now{_leader(db)}: this one steps down."
        )

    def _query(self, statement: str, *values: object) -> tuple[Any, ...] | None:
        with explained(self._session.name, StartError):
            return self._session.current().execute(statement, values).fetchone()

    def _lease_row(self) -> tuple[Any, ...]:
        row = self._query(LAST_SEEN)
        if row is None:
            raise self._session.damaged()
        return row

    def _refuse_second(self) -> NoReturn:
        raise OtherLeader(
            f"The plant of {self._session.name} is led by another process{_leader(self._session.current())}:"
            " end it first, or have this one wait with --standby."
        )


def _leader(db: Impatient) -> str:
    """Process and host of the leader in brackets, for a sentence; "" if they cannot be read."""
    try:
        row = db.execute("SELECT host, process FROM leader").fetchone()
    except psycopg.Error:
        return ""
    return "" if row is None else f" (process {row[1]} on {plain(str(row[0]))})"
