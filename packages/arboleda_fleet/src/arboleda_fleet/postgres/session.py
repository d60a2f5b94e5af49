"""The session of a plant with its server, and others beside it."""

from __future__ import annotations

from arboleda.extension import ArboledaError, StartError

from .schema import prepare, schema_of
from .server import Impatient, checked, connected, explained

REMEDY = "put a backup in its place"


class Session:
    """The session of one thread, between `open` and `close`; a session that was lost is begun anew."""

    def __init__(self, address: str, plant: str) -> None:
        self.name = f"{address} ({plant})"
        self._address = checked(address)
        self._schema = schema_of(plant)
        self._opened: Impatient | None = None
        self._is_open = False

    def open(self) -> None:
        """Make the plant's tables where they are missing; raises StartError. Idempotent."""
        if self._is_open:
            return
        with explained(self.name, StartError):
            db = self.another()
            try:
                prepare(db, self._schema, self.name)
            except BaseException:  # whatever it is, Ctrl-C too, the connection is not left open
                db.close()
                raise
        self._opened, self._is_open = db, True

    def another(self) -> Impatient:
        """A new session with the server; raises psycopg.Error or StartError."""
        return connected(self._address, self._schema)

    def current(self) -> Impatient:
        """The session itself; raises ArboledaError once it is closed, psycopg.Error or StartError."""
        if not self._is_open:
            raise ArboledaError(f"The plant's memory {self.name} is closed.")
        if self._opened is None or self._opened.closed:
            self._opened = self.another()
        return self._opened

    def beside(self, statement: str, *values: object) -> None:
        """Run a statement in a session of its own: the other one belongs to the plant's thread."""
        with explained(self.name, ArboledaError, "cannot be reached"), self.another() as db:
            db.execute(statement, values)

    def drop(self) -> None:
        """End the session that was lost."""
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def close(self) -> None:
        """End the session; idempotent."""
        self._is_open = False
        self.drop()

    def damaged(self) -> ArboledaError:
        """The error for a row that is not as it was written."""
        return ArboledaError(
            f"The plant's memory {self.name} cannot be used (a row is not as it was written): {REMEDY}."
        )
