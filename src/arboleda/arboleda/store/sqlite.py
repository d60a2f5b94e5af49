"""A plant's memory in one SQLite file: facts, tasks, and the operators' journal.

A commit appends to the log of the file (`-wal`) and waits for no disk: it survives a killed process. `sync`
has the system write the log to the disk, by a descriptor of its own: from any thread, and while the plant
commits more. `fold` brings the log into the file, by a connection of its own. What is noted is in a file
beside them (`-ahead`) until it is committed. How far people were told is beside them, too (`told_number.py`).
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, suppress
from pathlib import Path
from typing import Any

from arboleda.host.files import sync_data
from arboleda.host.machine import this_boot
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import Remember

from . import row_sums
from .ahead import Ahead
from .held_files import HeldFiles
from .main_file import MainFile
from .memory_file import (
    BOOT,
    BUSY_S,
    MOVE_AWAY,
    OWNER,
    PUT_BACK,
    VERSION,
    boot,
    explained,
    owner,
    refuse_damage,
    refuse_other,
    refuse_version,
    version,
)
from .plant_memory import PlantMemory
from .rows import Statement, row_of_fact
from .told_number import Told

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
CHOICE = ("ALTER TABLE task ADD COLUMN choice TEXT",)
COURSE = ("ALTER TABLE task ADD COLUMN course TEXT",)
UNCHECKED = ("ALTER TABLE task ADD COLUMN unchecked TEXT",)
AGES = (
    # how long the plant had run, over all of its starts, when a task ended
    "ALTER TABLE task ADD COLUMN ran_s REAL",
    "CREATE INDEX task_ran ON task (ran_s) WHERE ran_s IS NOT NULL",
    "UPDATE task SET ran_s = 0 WHERE ended_s IS NOT NULL",
)
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
    *CHOICE,
    *COURSE,
    *row_sums.COLUMNS,
    *UNCHECKED,
    *AGES,
    *row_sums.COUNT,
)
SINCE = {
    1: ("ALTER TABLE journal ADD COLUMN cell TEXT",),
    2: ("ALTER TABLE journal ADD COLUMN said TEXT",),
    3: TASKS,
    4: WHO_AND_HOW_OFTEN,
    5: ANSWERS,
    6: TIMES_OF_CELLS,
    7: CHOICE,
    8: COURSE,
    9: row_sums.COLUMNS,
    10: UNCHECKED,
    11: AGES,
    12: row_sums.COUNT,
}
IN_MEMORY = Path(":memory:")
FOLDED = 250  # commits after which the log is folded into the file: about 1,250 pages
LONGEST_LOG = 10_000  # pages at which a commit does that itself
NOTE_DAMAGED = (
    "{path} is not as it was written, and it may say what robots were told last: look what their effectors"
    " hold, move it away and start again."
)
IN_PLACE = "start again; as the plant ends now, all that it kept goes into the memory itself, if it is there"


class Store(PlantMemory):
    """Memory of a plant in one SQLite file; raises StartError if it is not that of `plant` ("": any)."""

    remedy = f"put a copy in its place, or {MOVE_AWAY}"

    def __init__(self, path: Path, plant: str = "") -> None:
        super().__init__()
        self.path = path
        self.name = str(path)
        self._plant = plant
        self._opened: sqlite3.Connection | None = None
        self._folder: sqlite3.Connection | None = None  # a connection of its own, for another thread
        self._unfolded = 0  # commits since the log was folded
        self._log_file: int | None = None  # the descriptor by which the log is synced
        self._boot = this_boot()
        self._ends_well = False  # whether closing it ends a start that lacks nothing
        self._held = HeldFiles()
        self._ahead = None if path == IN_MEMORY else Ahead(Path(f"{path}-ahead"), self._boot)
        self._noted: Sequence[Remember] = ()
        self._told: Told | None = None
        self._main: MainFile | None = None

    def open(self) -> None:
        """Open the file, or make a new one; raises StartError. Idempotent."""
        if self._opened is not None:
            return
        with self._explained(StartError):
            told = None if self.path == IN_MEMORY else Told(self.path)
            if not self._is_there(told):
                _make(self.path)
            elif told is not None:
                told.refuse_older()
            db = sqlite3.connect(self.path, timeout=BUSY_S, isolation_level=None, check_same_thread=False)
            try:
                self._prepare(db)
                db.execute("PRAGMA synchronous = NORMAL")
                db.execute(f"PRAGMA wal_autocheckpoint = {LONGEST_LOG}")
            except BaseException:  # whatever it is, Ctrl-C too, the file is not left open
                db.close()
                raise
        self._opened = db
        self.may_lack_writes = boot(db) not in (None, self._boot)
        if self._ahead is not None and told is not None:
            self._held = HeldFiles([self.path, self._log])
            self._log_file = os.open(self._log, os.O_RDONLY)
            with self._explained(StartError):
                self._folder = sqlite3.connect(self.path, isolation_level=None, check_same_thread=False)
                version(self._folder)  # it opens the file when it is first used
                told.open()
                self._told, self._main = told, MainFile(self.path, told)
                if told.path.exists():
                    with suppress(sqlite3.Error, ArboledaError, OSError):
                        self._main.fold(self._folder)  # what a kill cut short; it syncs the file first
                self._noted = self._ahead.read()
            self.settle()
            with self._explained(StartError):
                self._ahead.clear()

    def close(self) -> None:
        """Close the file; idempotent."""
        if self._opened is not None:
            with suppress(ArboledaError):  # the next start finds what is noted
                self.settle()
            if self._held.loss() is not None:
                with suppress(sqlite3.Error):  # SQLite itself does not read the log of a moved file
                    self._opened.execute("PRAGMA wal_checkpoint(TRUNCATE)")
            self._held = HeldFiles()
            if self._ends_well:
                with suppress(sqlite3.Error):  # then the next start is more careful than it need be
                    self._opened.execute(*row_of_fact(BOOT, None))
                self._ends_well = False
            if self._told is not None:
                self._told.close()
                self._told = self._main = None
            if self._folder is not None:
                self._folder.close()
                self._folder = None
            self._opened.close()
            self._opened = None
            self._noted = ()
            if self._ahead is not None:
                with suppress(OSError):
                    self._ahead.close()
        if self._log_file is not None:
            os.close(self._log_file)
            self._log_file = None

    def begin(self, *facts: Remember) -> None:
        """Commit as well on which boot of its host this start writes: a later one may lack its end."""
        rows = (row_of_fact((fact.fact.value, fact.name), fact.value) for fact in facts)
        self.write(*rows, row_of_fact(BOOT, self._boot), durable=True)
        self._ends_well, self.may_lack_writes = True, False

    def note(self, *facts: Remember) -> None:
        """Write facts beside the memory, which takes a third of the time of a commit."""
        if self._noted:
            self.settle()
        if self._ahead is not None and self._ahead.takes(facts):
            self._noted = facts
        else:
            self.keep(*facts)

    def settle(self) -> None:
        if self._noted:
            facts, self._noted = self._noted, ()
            self.keep(*facts)
            if self._ahead is not None:
                with self._explained(ArboledaError):
                    self._ahead.clear()

    def sync(self) -> None:
        try:
            with self.timing, self._explained(ArboledaError):
                number = 0 if self._told is None else self._told.number()
                self._wait_for_disk()
        except ArboledaError:
            self._ends_well = False
            raise
        self.confirm()
        if self._told is not None:
            self._told.tell(number)

    def fold(self) -> None:
        if self._folder is not None and self._main is not None and self._unfolded >= FOLDED:
            self._unfolded = 0
            with suppress(
                sqlite3.Error, ArboledaError, OSError
            ):  # the log grows on, until a commit cannot be made
                self._main.fold(self._folder)

    def look(self) -> None:
        """Raises ArboledaError as well if another program has written into the file."""
        self.confirm()
        main = self._main  # another thread may close the memory meanwhile
        if main is not None:
            main.look()

    def confirm(self) -> None:
        """Raises ArboledaError if the open file is no longer in its place: later writes would be lost.

        Callable from any thread; takes some microseconds.
        """
        loss = self._held.loss()
        if loss is not None:
            advice = IN_PLACE if loss.path == self._log else PUT_BACK
            raise ArboledaError(f"The plant's memory {self.path} cannot be used any more ({loss}): {advice}.")

    def _wait_for_disk(self) -> None:
        if self._log_file is not None:
            sync_data(self._log_file)

    @property
    def _log(self) -> Path:
        return Path(f"{self.path}-wal")

    @property
    def _db(self) -> sqlite3.Connection:
        if self._opened is None:
            raise ArboledaError(f"The plant's memory {self.path} is closed.")
        return self._opened

    def write(self, *statements: Statement, durable: bool) -> None:
        self.settle()
        self._unfolded += 1
        with self._explained(ArboledaError):
            if len(statements) == 1:
                self._db.execute(*statements[0])
            else:
                _carry_out(self._db, statements)
        self.confirm()  # after the commit, so that nobody hears of a write to a file that is not in its place

    def read(self, statement: str, *values: object) -> list[tuple[Any, ...]]:
        self.settle()
        with self._explained(ArboledaError):
            return self._db.execute(statement, values).fetchall()

    def _prepare(self, db: sqlite3.Connection) -> None:
        """Refuse a file that cannot be used now, rather than at the first fact."""
        row_sums.know(db)
        found = version(db)
        if found or self.path != IN_MEMORY:
            refuse_version(db, self.path)
        else:
            _carry_out(db, _made(db, SCHEMA))
        db.execute("PRAGMA journal_mode = WAL")
        with db:
            db.execute("BEGIN IMMEDIATE")  # refused where another program writes, or nobody may
        refuse_damage(db)
        if 0 < found < VERSION:
            news = [each for since, statements in SINCE.items() if since >= found for each in statements]
            _carry_out(db, _made(db, news))
        row_sums.watch(db)
        if self._plant:
            self._claim(db)
        if self._ahead is not None and boot(db) == self._boot and self._ahead.is_damaged():
            raise StartError(NOTE_DAMAGED.format(path=self._ahead.path))

    def _claim(self, db: sqlite3.Connection) -> None:
        """Enter the plant's name in a memory that has none; raises StartError if it is another plant's."""
        refuse_other(db, self.path, self._plant)
        if owner(db) is None:
            db.execute("INSERT INTO fact (fact, name, value) VALUES (?, ?, ?)", (*OWNER, self._plant))

    def damaged(self) -> ArboledaError:
        return ArboledaError(
            f"The plant's memory {self.path} cannot be used (a row is not as it was written): {MOVE_AWAY}."
        )

    def _is_there(self, told: Told | None) -> bool:
        """True if there is a memory to open; raises StartError if only a part of one is there."""
        if told is None or self.path.exists():
            return True
        for left in (self._log, told.path):
            if left.exists():
                gone = f"The plant's memory {self.path} is gone, but {left} is there"
                raise StartError(f"{gone}: put it back, or {MOVE_AWAY}.")
        return False

    def _explained(self, kind: type[ArboledaError]) -> AbstractContextManager[None]:
        return explained(self.path, kind)


def _make(path: Path) -> None:
    """Make an empty memory. It appears with all its tables: one that has none was not made here."""
    fresh = path.with_name(f".{path.name}.new")
    fresh.unlink(missing_ok=True)
    db = sqlite3.connect(fresh, isolation_level=None)
    try:
        row_sums.know(db)
        _carry_out(db, _made(db, SCHEMA))
        db.close()
        fresh.replace(path)
    finally:
        db.close()
        fresh.unlink(missing_ok=True)


def _made(db: sqlite3.Connection, statements: Iterable[str]) -> Iterator[str]:
    """The SQL statements that bring a file to the present format, with checksums of all rows."""
    yield from statements
    yield from row_sums.fill(db)
    yield f"PRAGMA user_version = {VERSION}"


def _carry_out(db: sqlite3.Connection, statements: Iterable[str | Statement]) -> None:
    """Run all of the statements in one transaction."""
    with db:
        db.execute("BEGIN IMMEDIATE")
        for each in statements:
            db.execute(*((each,) if isinstance(each, str) else each))
