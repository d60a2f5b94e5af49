"""What must survive a restart of the plant, in one SQLite file: facts and the operators' journal."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from arboleda.core.errors import ArboledaError, StartError
from arboleda.core.messages import Fact, Journal, Remember

VERSION = 1
SCHEMA = (
    "CREATE TABLE fact (fact TEXT, name TEXT, value TEXT NOT NULL, PRIMARY KEY (fact, name)) WITHOUT ROWID",
    "CREATE TABLE journal (id INTEGER PRIMARY KEY, unix_s REAL NOT NULL, verb TEXT NOT NULL,"
    " scope TEXT NOT NULL, sentence TEXT NOT NULL)",
    f"PRAGMA user_version = {VERSION}",
)
BUSY_S = 1.0  # a person may look into the file with another program; the plant's own lock keeps plants apart

MOVE_AWAY = (
    "move it away, together with its -wal and -shm files, and start again; lost with it are stop latches,"
    " what the effectors hold, quarantined zones and the operators' journal"
)
ADVICE = {  # by what SQLite says; Python 3.10 tells no codes
    "not a database": MOVE_AWAY,
    "malformed": MOVE_AWAY,
    "full": "make room on the disk and start again; what was kept before is not lost",
    "readonly": "let this user write the file and its directory",
    "unable to open": "make its directory, and let this user read and write both",
    "locked": "close the other program that uses it, and start again",
    "I/O error": "look at the disk",
}


@dataclass(frozen=True, kw_only=True)
class JournalEntry:
    """One act of an operator; `id` grows by one, `unix_s` is what the clock of the plant's machine said."""

    id: int
    unix_s: float
    verb: str
    scope: str
    sentence: str


class Store:
    """The memory of a plant, between `open` and `close` or as `with` does it; one thread at a time.

    What a method wrote survives a killed process once the method has returned; stop latches and the journal
    survive a power cut too. ArboledaError says what is wrong with the file, and what to do.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._opened: sqlite3.Connection | None = None
        self._durable: bool | None = None  # what commits are now; None: not said yet

    def open(self) -> None:
        """Open the file, a new one where there is none; StartError; idempotent."""
        if self._opened is not None:
            return
        with self._explained(StartError):
            db = sqlite3.connect(self.path, timeout=BUSY_S, isolation_level=None, check_same_thread=False)
            try:
                self._prepare(db)
            except BaseException:  # whatever it is, Ctrl-C too, the file is not left open
                db.close()
                raise
        self._opened, self._durable = db, None

    def close(self) -> None:
        """Give the file back; idempotent."""
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def keep(self, fact: Remember) -> None:
        """Commit the fact, or forget it where its value is None."""
        key = (fact.fact.value, fact.name)
        durable = fact.fact is Fact.LATCH
        if fact.value is None:
            self._commit("DELETE FROM fact WHERE fact = ? AND name = ?", key, durable=durable)
        else:
            self._commit("INSERT OR REPLACE INTO fact VALUES (?, ?, ?)", (*key, fact.value), durable=durable)

    def facts(self, fact: Fact) -> dict[str, str]:
        """Name to value of what is remembered."""
        with self._explained(ArboledaError):
            rows = self._db.execute(
                "SELECT name, value FROM fact WHERE fact = ? ORDER BY name", (fact.value,)
            )
            return dict(rows.fetchall())

    def journal(self, entry: Journal, unix_s: float) -> None:
        """Commit one act of an operator."""
        row = (unix_s, entry.verb.value, entry.scope, entry.sentence)
        insert = "INSERT INTO journal (unix_s, verb, scope, sentence) VALUES (?, ?, ?, ?)"
        self._commit(insert, row, durable=True)

    def entries(self, limit: int = 100) -> list[JournalEntry]:
        """The last acts, the newest first."""
        columns = "id", "unix_s", "verb", "scope", "sentence"
        query = f"SELECT {', '.join(columns)} FROM journal ORDER BY id DESC LIMIT ?"
        with self._explained(ArboledaError):
            rows = self._db.execute(query, (limit,)).fetchall()
        return [JournalEntry(**dict(zip(columns, row, strict=True))) for row in rows]

    def __enter__(self) -> Store:
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def _db(self) -> sqlite3.Connection:
        if self._opened is None:
            raise ArboledaError(f"The plant's memory {self.path} is closed.")
        return self._opened

    def _commit(self, statement: str, values: tuple[object, ...], *, durable: bool) -> None:
        with self._explained(ArboledaError):
            if durable is not self._durable:  # most commits are as the one before: a command waits for them
                self._db.execute(f"PRAGMA synchronous = {'FULL' if durable else 'NORMAL'}")
                self._durable = durable
            self._db.execute(statement, values)

    def _prepare(self, db: sqlite3.Connection) -> None:
        """Refuse what cannot be used now, rather than at the first fact."""
        if (version := _version(db)) > VERSION:
            raise StartError(
                f"The plant's memory {self.path} is of a newer Arboleda (format {version}, known: {VERSION}):"
                f" use that one, or {MOVE_AWAY}."
            )
        db.execute("PRAGMA journal_mode = WAL")
        with db:
            db.execute("BEGIN IMMEDIATE")
            if _version(db) == 0:
                for statement in SCHEMA:
                    db.execute(statement)
        if db.execute("PRAGMA quick_check(1)").fetchone() != ("ok",):
            raise sqlite3.DatabaseError("database disk image is malformed")

    @contextmanager
    def _explained(self, kind: type[ArboledaError]) -> Iterator[None]:
        """Turn what SQLite raises into one sentence."""
        try:
            yield
        except sqlite3.Error as error:
            advice = next((ADVICE[words] for words in ADVICE if words in str(error)), MOVE_AWAY)
            raise kind(f"The plant's memory {self.path} cannot be used ({error}): {advice}.") from error


def _version(db: sqlite3.Connection) -> int:
    return int(db.execute("PRAGMA user_version").fetchone()[0])
