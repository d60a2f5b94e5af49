"""Tasks of a plant in PostgreSQL, for readers only."""

from __future__ import annotations

import select
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.store.task_rows import Database, History

from .schema import VERSION, exists, refuse_newer, schema_of, version
from .server import Impatient, checked, connected, explained, plain_values, translated


class PostgresHistory(History):
    """Task history on a connection of its own, so that neither a reader nor the plant waits for the other."""

    def __init__(self, address: str, plant: str) -> None:
        self._address = checked(address)
        self._name = f"{address} ({plant})"
        self._schema = schema_of(plant)
        self._lock = threading.Lock()
        self._opened: Impatient | None = None

    @contextmanager
    def _reading(self) -> Iterator[Database | None]:
        with self._lock, explained(self._name, ArboledaError, "cannot be read"):
            db = self._db()
            yield None if db is None else _Reader(db)

    def close(self) -> None:
        with self._lock:
            if self._opened is not None:
                self._opened.close()
                self._opened = None

    def _db(self) -> Impatient | None:
        if self._opened is not None and _was_ended(self._opened):
            self._opened.close()
        if self._opened is None or self._opened.closed:
            db = connected(self._address, self._schema)
            try:
                if not exists(db, self._schema):
                    db.close()
                    return None
                self._check(version(db))
            except BaseException:  # whatever it is, the connection is not left open
                db.close()
                raise
            self._opened = db
        return self._opened

    def _check(self, found: int) -> None:
        refuse_newer(found, self._name)
        if found < VERSION:
            raise ArboledaError(
                f"The plant's memory {self._name} is of an older Arboleda: start the plant once, which"
                " brings it up to date."
            )


class _Reader:
    """Database connection that takes queries as they are written for every store."""

    def __init__(self, db: Impatient) -> None:
        self._db = db

    def execute(self, statement: str, values: tuple[object, ...] = ()) -> Iterable[tuple[Any, ...]]:
        return self._db.execute(translated(statement), plain_values(values))


def _was_ended(db: Impatient) -> bool:
    """True if the server has sent something unasked, as it does when it ends."""
    return not db.closed and bool(select.select([db.fileno()], [], [], 0.0)[0])
