"""What must survive a restart of the plant, in one SQLite file: facts, tasks, and the operators' journal."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import (
    Fact,
    Journal,
    Remember,
    TaskAnswer,
    TaskChanged,
    TaskState,
    outlives_power,
)

from .memory_file import (
    BUSY_S,
    MOVE_AWAY,
    OWNER,
    VERSION,
    explained,
    owner,
    refuse_damage,
    refuse_other,
    refuse_version,
    version,
)
from .task_rows import TaskQuery, TaskRow, selected

TASKS = (
    # `ended_s` is null as long as a task waits or runs; times are Unix times
    "CREATE TABLE task (number INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, text TEXT NOT NULL,"
    " cell TEXT NOT NULL, recipe TEXT NOT NULL, state TEXT NOT NULL, reason TEXT, sentence TEXT, said TEXT,"
    " accepted_s REAL NOT NULL, started_s REAL, ended_s REAL)",
    "CREATE INDEX task_open ON task (number) WHERE ended_s IS NULL",
    "CREATE INDEX task_ended ON task (ended_s) WHERE ended_s IS NOT NULL",
)
WHO_AND_HOW_OFTEN = (
    "ALTER TABLE task ADD COLUMN asked_by TEXT",
    "ALTER TABLE task ADD COLUMN attempts INTEGER NOT NULL DEFAULT 0",
)
ANSWERS = ("ALTER TABLE task ADD COLUMN answers TEXT",)
TIMES_OF_CELLS = (
    # from which second to which a cell did no work; `until_s` is null while it lasts
    "CREATE TABLE down (number INTEGER PRIMARY KEY, cell TEXT NOT NULL, state TEXT NOT NULL,"
    " since_s REAL NOT NULL, until_s REAL)",
    "CREATE INDEX down_open ON down (cell) WHERE until_s IS NULL",
    # each start of the plant, until when it is known to have run, and whether it was ended or killed
    "CREATE TABLE run (number INTEGER PRIMARY KEY, since_s REAL NOT NULL, seen_s REAL NOT NULL,"
    " ended INTEGER NOT NULL)",
)
SCHEMA = (
    "CREATE TABLE fact (fact TEXT, name TEXT, value TEXT NOT NULL, PRIMARY KEY (fact, name)) WITHOUT ROWID",
    "CREATE TABLE journal (id INTEGER PRIMARY KEY, unix_s REAL NOT NULL, verb TEXT NOT NULL,"
    " scope TEXT NOT NULL, sentence TEXT NOT NULL, cell TEXT, said TEXT)",
    *TASKS,
    *WHO_AND_HOW_OFTEN,
    *ANSWERS,
    *TIMES_OF_CELLS,
    f"PRAGMA user_version = {VERSION}",
)
SINCE = {
    1: ("ALTER TABLE journal ADD COLUMN cell TEXT",),
    2: ("ALTER TABLE journal ADD COLUMN said TEXT",),
    3: TASKS,
    4: WHO_AND_HOW_OFTEN,
    5: ANSWERS,
    6: TIMES_OF_CELLS,
}
PRUNED = 20  # ended tasks that are forgotten with one that ends: many more than end meanwhile, and soon done
IN_MEMORY = Path(":memory:")
Statement = tuple[str, tuple[object, ...]]  # with its values


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

    What a method wrote survives a killed process once the method has returned; stop latches, the journal,
    and that a task was accepted, has begun or has ended survive a power cut too. ArboledaError says what is
    wrong with the file, and what to do. It is refused where it is not the memory of `plant`; "" asks for
    none.
    """

    def __init__(self, path: Path, plant: str = "") -> None:
        self.path = path
        self._plant = plant
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

    def keep(self, *facts: Remember) -> None:
        """Commit facts, or forget those whose value is None: all of them, or none."""
        durable = any(outlives_power(fact) for fact in facts)
        with self._explained(ArboledaError):
            self._sync(durable=durable)
            if len(facts) == 1:
                self._db.execute(*_kept(facts[0]))
            else:
                _carry_out(self._db, [_kept(fact) for fact in facts])

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
        self._commit(insert, row, durable=outlives_power(entry))

    def task(
        self,
        change: TaskChanged,
        recipe: str,
        unix_s: float,
        asked_by: str | None = None,
        answers: Sequence[TaskAnswer] = (),
    ) -> None:
        """Commit one change of a task; what is known already, as when it is asked for again, stays.

        `answers` are kept with its end.
        """
        state, durable = change.state, outlives_power(change)
        if state is TaskState.QUEUED:
            row = (change.task, change.text, change.cell, recipe, state.value, unix_s, asked_by)
            columns = "id, text, cell, recipe, state, accepted_s, asked_by"
            insert = f"INSERT OR IGNORE INTO task ({columns}) VALUES (?, ?, ?, ?, ?, ?, ?)"
            self._commit(insert, row, durable=durable)
        elif state is TaskState.RUNNING:
            begin = (
                "UPDATE task SET state = ?, started_s = ?, attempts = 1 WHERE id = ? AND started_s IS NULL"
            )
            self._commit(begin, (state.value, unix_s, change.task), durable=durable)
        elif state is not TaskState.REFUSED:
            said = json.dumps(change.sentence.data(), ensure_ascii=False)
            reason = None if change.reason is None else change.reason.value
            end = (
                "UPDATE task SET state = ?, reason = ?, sentence = ?, said = ?, ended_s = ?, answers = ?"
                " WHERE id = ? AND ended_s IS NULL"
            )
            told = json.dumps([vars(each) for each in answers], ensure_ascii=False) if answers else None
            values = (state.value, reason, str(change.sentence), said, unix_s, told, change.task)
            self._commit(end, values, durable=durable)

    def attempted(self, task: str, attempts: int) -> None:
        """Commit how often a task was begun or tried again."""
        self._commit("UPDATE task SET attempts = ? WHERE id = ?", (attempts, task), durable=False)

    def forget_tasks(self, before_unix_s: float) -> None:
        """Forget the oldest tasks that ended before, at most PRUNED of them."""
        oldest = "SELECT number FROM task WHERE ended_s < ? ORDER BY ended_s LIMIT ?"
        delete = f"DELETE FROM task WHERE number IN ({oldest})"
        self._commit(delete, (before_unix_s, PRUNED), durable=False)

    def began(self, unix_s: float, before_unix_s: float) -> None:
        """Commit that the plant runs, and forget the times of cells that were over before."""
        last = "coalesce((SELECT seen_s FROM run ORDER BY number DESC LIMIT 1), since_s)"
        for statement, values in (
            (f"UPDATE down SET until_s = max(since_s, {last}) WHERE until_s IS NULL", ()),
            ("DELETE FROM down WHERE until_s < ?", (before_unix_s,)),
            ("DELETE FROM run WHERE seen_s < ?", (before_unix_s,)),
            ("INSERT INTO run (since_s, seen_s, ended) VALUES (?, ?, 0)", (unix_s, unix_s)),
        ):
            self._commit(statement, values, durable=False)

    def seen(self, unix_s: float, *, ended: bool = False) -> None:
        """Commit that the plant still runs, or that it was ended."""
        last = "number = (SELECT max(number) FROM run)"
        self._commit(f"UPDATE run SET seen_s = ?, ended = ? WHERE {last}", (unix_s, ended), durable=False)

    def stands(self, cell: str, state: str | None, unix_s: float) -> None:
        """Commit that a cell does no work from now on, in this state; or works again, where that is None."""
        over = "UPDATE down SET until_s = ? WHERE cell = ? AND until_s IS NULL"
        self._commit(over, (unix_s, cell), durable=False)
        if state is not None:
            begun = "INSERT INTO down (cell, state, since_s) VALUES (?, ?, ?)"
            self._commit(begun, (cell, state, unix_s), durable=False)

    def tasks(self, query: TaskQuery) -> list[TaskRow]:
        """The tasks that a query asks for, the last accepted first."""
        with self._explained(ArboledaError):
            return selected(self._db, query)

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
            self._sync(durable=durable)
            self._db.execute(statement, values)

    def _sync(self, *, durable: bool) -> None:
        """Whether the next commits survive a power cut."""
        if durable is not self._durable:  # most commits are as the one before: a command waits for them
            self._db.execute(f"PRAGMA synchronous = {'FULL' if durable else 'NORMAL'}")
            self._durable = durable

    def _prepare(self, db: sqlite3.Connection) -> None:
        """Refuse what cannot be used now, rather than at the first fact."""
        found = version(db)
        if found or self.path != IN_MEMORY:
            refuse_version(db, self.path)
        else:
            _carry_out(db, SCHEMA)
        db.execute("PRAGMA journal_mode = WAL")
        with db:
            db.execute("BEGIN IMMEDIATE")  # refused where another program writes, or nobody may
        refuse_damage(db)
        if 0 < found < VERSION:
            news = [each for since, statements in SINCE.items() if since >= found for each in statements]
            _carry_out(db, (*news, f"PRAGMA user_version = {VERSION}"))
        if self._plant:
            self._claim(db)

    def _claim(self, db: sqlite3.Connection) -> None:
        """Say whose memory it is where nothing does; StartError where it is another plant's."""
        refuse_other(db, self.path, self._plant)
        if owner(db) is None:
            db.execute("INSERT INTO fact VALUES (?, ?, ?)", (*OWNER, self._plant))

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

    def _explained(self, kind: type[ArboledaError]) -> AbstractContextManager[None]:
        return explained(self.path, kind)


def _kept(fact: Remember) -> Statement:
    key = (fact.fact.value, fact.name)
    if fact.value is None:
        return "DELETE FROM fact WHERE fact = ? AND name = ?", key
    return "INSERT OR REPLACE INTO fact VALUES (?, ?, ?)", (*key, fact.value)


def _carry_out(db: sqlite3.Connection, statements: Iterable[str | Statement]) -> None:
    """All of them, or none."""
    with db:
        db.execute("BEGIN IMMEDIATE")
        for each in statements:
            db.execute(*((each,) if isinstance(each, str) else each))
