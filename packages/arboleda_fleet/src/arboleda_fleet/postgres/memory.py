"""A plant's memory in PostgreSQL: each write is one statement, which checks that its writer still leads."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import nullcontext
from typing import Any, TypeVar

import psycopg

from arboleda.adapters import clock
from arboleda.departures.leading import AGAIN_S
from arboleda.extension import ArboledaError
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.rows import Statement

from .lead import PAUSE_S, PostgresLead
from .schema import SUPERSEDED
from .server import Impatient, explained, plain_values, translated
from .session import REMEDY, Session

T = TypeVar("T")


class PostgresMemory(PlantMemory):
    """Memory of `plant` in the database at an address; nothing is written before `lead` is taken."""

    remedy = REMEDY
    lead: PostgresLead

    def __init__(self, address: str, plant: str) -> None:
        super().__init__()
        self.session = Session(address, plant)
        self.name = self.session.name
        self.lead = PostgresLead(self.session)

    def open(self) -> None:
        self.session.open()

    def close(self) -> None:
        """Give up the lead at once, if the server can be reached; idempotent."""
        self.lead.give_up()
        self.session.close()

    def confirm(self) -> None:
        if not self.lead.is_certain:
            self._patiently(lambda db: self.lead.renew_by(db))

    def write(self, *statements: Statement, durable: bool) -> None:
        if self.lead.epoch is None:
            raise ArboledaError(f"The plant's memory {self.name} is not led by this process.")
        parts = [f"w{n} AS ({text} RETURNING 1)" for n, (text, _) in enumerate(statements)]
        begin = f"WITH {', '.join(parts)} " if parts else ""
        values = [value for _, each in statements for value in each]
        statement = translated(f"{begin}SELECT fenced(?, ?)")
        parameters = plain_values((*values, self.lead.epoch, durable))
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
                    return do(self.session.current())
            except ArboledaError as error:
                self._explain_end(error)
                if clock.seconds() >= until:
                    raise
                self.session.drop()
                time.sleep(PAUSE_S)

    def _explain_end(self, error: ArboledaError) -> None:
        """Raise an error that another attempt would not mend."""
        cause = error.__cause__
        if isinstance(cause, psycopg.Error) and cause.sqlstate == SUPERSEDED:
            raise self.lead.superseded(self.session.current()) from cause
        if not isinstance(cause, psycopg.OperationalError | psycopg.InterfaceError):
            raise error

    def damaged(self) -> ArboledaError:
        return self.session.damaged()
