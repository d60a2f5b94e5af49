"""A plant's memory in PostgreSQL: each write is one statement, which checks that its writer still leads."""

from __future__ import annotations

import json
import os
import socket
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext, suppress
from typing import Any, NoReturn, TypeVar

import psycopg

from arboleda.adapters import clock
from arboleda.departures.leading import AGAIN_S, LEASE_S, RENEW_S, WANTED_S, Lease, Silence
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.outside import plain
from arboleda.store.plant_memory import OtherLeader, PlantMemory, Standby, Statement, Superseded

from .leader_row import END_LEASE, LAST_SEEN, lately
from .schema import SUPERSEDED, prepare, schema_of
from .server import Impatient, checked, connected, explained, own_address, plain_values, translated

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
T = TypeVar("T")


class PostgresMemory(PlantMemory):
    """Memory of `plant` in the database at an address; nothing is written before `lead`."""

    remedy = "put a backup in its place"
    renew_s = RENEW_S

    def __init__(self, address: str, plant: str) -> None:
        self.address = checked(address)
        self.name = f"{address} ({plant})"
        self._schema = schema_of(plant)
        self._opened: Impatient | None = None
        self._renewing: Impatient | None = None  # of the thread that renews
        self._is_open = False
        self._epoch: int | None = None
        self._lease = Lease()

    def open(self) -> None:
        if self._is_open:
            return
        with explained(self.name, StartError):
            db = self.connect()
            try:
                prepare(db, self._schema, self.name)
            except BaseException:  # whatever it is, Ctrl-C too, the connection is not left open
                db.close()
                raise
        self._opened, self._is_open = db, True

    def connect(self) -> Impatient:
        """A new session with the server; raises psycopg.Error or StartError."""
        return connected(self.address, self._schema)

    def close(self) -> None:
        """Give up the lead at once, if the server can be reached, so that no standby waits; idempotent."""
        if self._epoch is not None:
            with suppress(psycopg.Error, StartError):  # the lease ends by itself
                self._connection().execute("UPDATE leader SET seen = NULL WHERE epoch = %s", (self._epoch,))
        self._epoch, self._is_open = None, False
        self._drop()
        if self._renewing is not None:
            self._renewing.close()
            self._renewing = None

    def lead(self, epoch: int) -> int:
        """Take the lead, as in every memory; a killed leader is waited for as long as its lease lasts."""
        silence, first = Silence(), self._lease_row()
        while True:
            sent_at = clock.seconds()
            me = plain(socket.gethostname()), os.getpid()
            row = self._query(LEAD, epoch, *me, WANTED_S)
            if row is not None:
                self._epoch = int(row[0])
                self._lease.renewed(sent_at)
                self.going = tuple(json.loads(row[1]))
                self._query("UPDATE leader SET going = '[]' WHERE epoch = %s RETURNING epoch", self._epoch)
                return self._epoch
            lease = self._lease_row()
            if lease != first and lease[1] is not None:
                self._refuse_second()
            if silence.ends_lease(clock.seconds(), lease):
                self._query(END_LEASE, *lease)
            else:
                time.sleep(PAUSE_S)

    def renew(self) -> bool:
        if self._renewing is None or self._renewing.closed:
            with explained(self.name, ArboledaError, "cannot be reached"):
                self._renewing = self.connect()
        return self._renew(self._renewing)

    def own_address(self) -> str:
        with explained(self.name, ArboledaError, "cannot be reached"), self.connect() as db:
            return own_address(db)

    def announce(self, url: str) -> None:
        self._beside("UPDATE leader SET url = %s WHERE epoch = %s", url, self._epoch)

    def hand_over(self, going: Sequence[str]) -> None:
        self._beside("UPDATE leader SET going = %s WHERE epoch = %s", json.dumps(list(going)), self._epoch)

    def _beside(self, statement: str, *values: object) -> None:
        """Run a statement on a connection of its own: the other one belongs to the plant's thread."""
        with explained(self.name, ArboledaError, "cannot be reached"), self.connect() as db:
            db.execute(statement, values)

    def confirm(self) -> None:
        if not self._lease.lasts(clock.seconds()):
            self._patiently(lambda db: self._renew(db))

    @property
    def leads_for_certain(self) -> bool:
        return self._lease.lasts(clock.seconds())

    def _renew(self, db: Impatient) -> bool:
        """Renew the lease; True if another process is wanted as the leader."""
        sent_at = clock.seconds()
        with explained(self.name, ArboledaError, "cannot be reached"):
            row = db.execute(RENEW, (self._epoch, WANTED_S, LEASE_S)).fetchone()
        if row is None:
            raise self._superseded(db)
        self._lease.renewed(sent_at)
        self.standbys = tuple(Standby(host=plain(host), url=plain(url)) for host, url in row[1])
        return bool(row[0])

    def write(self, *statements: Statement, durable: bool) -> None:
        if self._epoch is None:
            raise ArboledaError(f"The plant's memory {self.name} is not led by this process.")
        parts = [f"w{n} AS ({text} RETURNING 1)" for n, (text, _) in enumerate(statements)]
        begin = f"WITH {', '.join(parts)} " if parts else ""
        values = [value for _, each in statements for value in each]
        statement = translated(f"{begin}SELECT fenced(?, ?)")
        parameters = plain_values((*values, self._epoch, durable))
        with self.timing if durable else nullcontext():
            self._patiently(lambda db: db.execute(statement, parameters))

    def sync(self) -> None:
        """Nothing is left to do: each commit already chose whether the server waits for its disk."""

    def read(self, statement: str, *values: object) -> list[tuple[Any, ...]]:
        return self._patiently(lambda db: db.execute(translated(statement), plain_values(values)).fetchall())

    def _patiently(self, do: Callable[[Impatient], T]) -> T:
        """Call `do`, again if the connection was lost: a statement that runs twice has the effect of one."""
        until = clock.seconds() + AGAIN_S
        while True:
            try:
                with explained(self.name, ArboledaError):
                    return do(self._connection())
            except ArboledaError as error:
                self._explain_end(error)
                if clock.seconds() >= until:
                    raise
                self._drop()
                time.sleep(PAUSE_S)

    def _explain_end(self, error: ArboledaError) -> None:
        """Raise an error that another attempt would not mend."""
        cause = error.__cause__
        if isinstance(cause, psycopg.Error) and cause.sqlstate == SUPERSEDED:
            raise self._superseded(self._connection()) from cause
        if not isinstance(cause, psycopg.OperationalError | psycopg.InterfaceError):
            raise error

    def _connection(self) -> Impatient:
        if not self._is_open:
            raise ArboledaError(f"The plant's memory {self.name} is closed.")
        if self._opened is None or self._opened.closed:
            self._opened = self.connect()
        return self._opened

    def _drop(self) -> None:
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def _query(self, statement: str, *values: object) -> tuple[Any, ...] | None:
        with explained(self.name, StartError):
            return self._connection().execute(statement, values).fetchone()

    def _lease_row(self) -> tuple[Any, ...]:
        row = self._query(LAST_SEEN)
        if row is None:
            raise self._damaged()
        return row

    def _refuse_second(self) -> NoReturn:
        raise OtherLeader(
            f"The plant of {self.name} is led by another process{_leader(self._connection())}: end it first,"
            " or have this one wait with --standby."
        )

    def _superseded(self, db: Impatient) -> Superseded:
        return Superseded(
            f"Another process leads the plant of {self.name} now{_leader(db)}: this one steps down."
        )

    def _damaged(self) -> ArboledaError:
        return ArboledaError(
            f"The plant's memory {self.name} cannot be used (a row is not as it was written): {self.remedy}."
        )


def _leader(db: Impatient) -> str:
    """Process and host of the leader in brackets, for a sentence; "" if they cannot be read."""
    try:
        row = db.execute("SELECT host, process FROM leader").fetchone()
    except psycopg.Error:
        return ""
    return "" if row is None else f" (process {row[1]} on {plain(str(row[0]))})"
