"""What must survive a restart of the plant, in one SQLite file: facts and the operators' journal."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from arboleda.core.errors import ArboledaError, StartError
from arboleda.core.messages import Fact, Journal, Remember

VERSION = 3
SCHEMA = (
    "CREATE TABLE fact (fact TEXT, name TEXT, value TEXT NOT NULL, PRIMARY KEY (fact, name)) WITHOUT ROWID",
    "CREATE TABLE journal (id INTEGER PRIMARY KEY, unix_s REAL NOT NULL, verb TEXT NOT NULL,"
    " scope TEXT NOT NULL, sentence TEXT NOT NULL, cell TEXT, said TEXT)",
    f"PRAGMA user_version = {VERSION}",
)
SINCE = {1: "ALTER TABLE journal ADD COLUMN cell TEXT", 2: "ALTER TABLE journal ADD COLUMN said TEXT"}
IN_MEMORY = Path(":memory:")
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
    "I/O error": "look at the disk, which may be full",
}


@dataclass(frozen=True, kw_only=True)
class JournalEntry:
    """One act of an operator; `id` grows by one, `unix_s` is what the clock of the plant's machine said.

    `cell` is None where the act was for more than one, or is older than this column; `said` is JSON of the
    sentence, None where it is older than that column.
    """

    id: int
    unix_s: float
    verb: str
    scope: str
    sentence: str
    cell: str | None
    said: str | None


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
            if not self._is_there():
                self._make()
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
            facts = rows.fetchall()
        if not all(isinstance(each, str) for row in facts for each in row):
            raise self._damaged()
        return dict(facts)

    def journal(self, entry: Journal, unix_s: float) -> None:
        """Commit one act of an operator."""
        said = json.dumps(entry.sentence.data(), ensure_ascii=False)
        row = (unix_s, entry.verb.value, entry.scope, str(entry.sentence), entry.cell, said)
        insert = "INSERT INTO journal (unix_s, verb, scope, sentence, cell, said) VALUES (?, ?, ?, ?, ?, ?)"
        self._commit(insert, row, durable=True)

    def entries(self, limit: int = 100) -> list[JournalEntry]:
        """The last acts, the newest first."""
        columns = "id", "unix_s", "verb", "scope", "sentence", "cell", "said"
        query = f"SELECT {', '.join(columns)} FROM journal ORDER BY id DESC LIMIT ?"
        with self._explained(ArboledaError):
            rows = self._db.execute(query, (limit,)).fetchall()
        for _, unix_s, *texts, cell, said in rows:
            known = [*texts, cell or "", said or ""]
            if not isinstance(unix_s, float) or not all(isinstance(text, str) for text in known):
                raise self._damaged()
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
        if version == 0:
            if self.path != IN_MEMORY:
                raise StartError(
                    f"The plant's memory {self.path} has lost its content, or is another program's: "
                    f"put a copy of it in its place, or {MOVE_AWAY}."
                )
            _carry_out(db, SCHEMA)
        db.execute("PRAGMA journal_mode = WAL")
        with db:
            db.execute("BEGIN IMMEDIATE")  # refused where another program writes, or nobody may
        if db.execute("PRAGMA quick_check(1)").fetchone() != ("ok",):
            raise sqlite3.DatabaseError("database disk image is malformed")
        if 0 < version < VERSION:
            news = [statement for since, statement in SINCE.items() if since >= version]
            _carry_out(db, (*news, f"PRAGMA user_version = {VERSION}"))

    def _damaged(self) -> ArboledaError:
        return ArboledaError(
            f"The plant's memory {self.path} cannot be used (a row is not as it was written): {MOVE_AWAY}."
        )

    def _is_there(self) -> bool:
        """Whether there is a memory to open; StartError where only a part of one is."""
        log = Path(f"{self.path}-wal")
        if self.path == IN_MEMORY or self.path.exists():
            return True
        if log.exists():
            raise StartError(
                f"The plant's memory {self.path} is gone, but {log} is there: put it back, or {MOVE_AWAY}."
            )
        return False

    def _make(self) -> None:
        """Make an empty memory. It appears with all its tables: one that has none was not made here."""
        fresh = self.path.with_name(f".{self.path.name}.new")
        fresh.unlink(missing_ok=True)
        db = sqlite3.connect(fresh, isolation_level=None)
        try:
            _carry_out(db, SCHEMA)
            db.close()
            fresh.replace(self.path)
        finally:
            db.close()
            fresh.unlink(missing_ok=True)

    @contextmanager
    def _explained(self, kind: type[ArboledaError]) -> Iterator[None]:
        """Turn what SQLite raises into one sentence."""
        try:
            yield
        except sqlite3.Error as error:
            # It quotes what it could not decode.
            what = "not UTF-8 text" if "decode to UTF-8" in str(error) else str(error)
            advice = next((ADVICE[words] for words in ADVICE if words in what), MOVE_AWAY)
            raise kind(f"The plant's memory {self.path} cannot be used ({what}): {advice}.") from error
        except OSError as error:
            what = error.strerror or str(error)
            raise kind(f"The plant's memory {self.path} cannot be used ({what}).") from error


def _carry_out(db: sqlite3.Connection, statements: tuple[str, ...]) -> None:
    """All of them, or none."""
    with db:
        db.execute("BEGIN IMMEDIATE")
        for statement in statements:
            db.execute(statement)


def _version(db: sqlite3.Connection) -> int:
    return int(db.execute("PRAGMA user_version").fetchone()[0])
