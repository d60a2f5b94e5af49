"""File of a plant's memory: checks that it can be used, with one sentence for each reason why not."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.outside import plain, quoted

from . import row_sums

VERSION = 13
VERSION_COUNTS = 13  # from this one on a memory counts its changes
BUSY_S = 1.0  # a person may look into the file with another program; the plant's own lock keeps plants apart
OWNER = ("plant", "name")  # the row of `fact` that says whose memory it is; no `Fact` has this name
BOOT = ("host", "boot")  # the row that says on which boot of its host a start writes that has not ended yet
LOST_WITH_IT = (
    "lost with it are stop latches, what the effectors hold, quarantined zones, the tasks and the operators'"
    " journal"
)
MOVE_AWAY = (
    f"move it away, together with its -wal, -shm, -ahead and .told files, and start again; {LOST_WITH_IT}"
)
PUT_BACK = f"put it, or a backup, in its place and start again; {LOST_WITH_IT}"
ADVICE = {  # by SQLite's text; Python 3.10 has no error codes
    "not a database": MOVE_AWAY,
    "malformed": MOVE_AWAY,
    "full": "make room on the disk and start again; what was kept before is not lost",
    "readonly": "let this user write the file and its directory",
    "unable to open": "make its directory, and let this user read and write both",
    "locked": "close the other program that uses it, and start again",
    "I/O error": "look at the disk, which may be full",
}


SPOILT = (sqlite3.Error, UnicodeDecodeError)  # SQLite raises the second for a name that is no UTF-8
UNMADE = ("unable to open", "I/O error", "readonly")  # SQLite's errors if it cannot make its log


@contextmanager
def explained(path: Path, kind: type[ArboledaError], cannot: str = "cannot be used") -> Iterator[None]:
    """Context that turns errors of SQLite and the system into one sentence on the plant's memory."""
    try:
        yield
    except SPOILT as error:
        what = in_words(error)
        raise kind(f"The plant's memory {path} {cannot} ({what}): {advice(what)}.") from error
    except OSError as error:
        what = error.strerror or str(error)
        raise kind(f"The plant's memory {path} {cannot} ({what}).") from error


def in_words(error: sqlite3.Error | UnicodeDecodeError) -> str:
    """SQLite's error on one line, without the bytes that it could not decode."""
    if isinstance(error, UnicodeDecodeError) or "decode to UTF-8" in str(error):
        return "not UTF-8 text"
    return plain(str(error))


def advice(what: str) -> str:
    """The advice to the user for an error in these words."""
    return next((ADVICE[words] for words in ADVICE if words in what), MOVE_AWAY)


def read_only(path: Path) -> sqlite3.Connection:
    """A connection that only reads, for one thread at a time; raises sqlite3.Error if there is no file."""
    db = _connected(path, "mode=ro")
    try:
        version(db)
    except SPOILT as error:
        db.close()
        log, unmade = Path(f"{path}-wal"), any(words in str(error) for words in UNMADE)
        if not unmade or not path.exists() or (log.exists() and log.stat().st_size):
            raise
        # Read-only, or with a full disk, no log can be made; without one nothing is missing.
        db = immutable(path)
    return db


def immutable(path: Path) -> sqlite3.Connection:
    """A connection that reads the main file alone, without its log."""
    return _connected(path, "mode=ro&immutable=1")


def _connected(path: Path, how: str) -> sqlite3.Connection:
    address = f"{path.resolve().as_uri()}?{how}"
    return sqlite3.connect(address, uri=True, timeout=BUSY_S, isolation_level=None, check_same_thread=False)


def version(db: sqlite3.Connection) -> int:
    """The version of the format; 0 for a file that Arboleda did not make."""
    return int(db.execute("PRAGMA user_version").fetchone()[0])


def refuse_version(db: sqlite3.Connection, path: Path) -> None:
    """Raises StartError if the memory is of a newer Arboleda, or is none."""
    found = version(db)
    if found > VERSION:
        raise StartError(
            f"The plant's memory {path} is of a newer Arboleda (format {found}, known: {VERSION}):"
            f" use that one, or {MOVE_AWAY}."
        )
    if found == 0:
        raise StartError(
            f"The plant's memory {path} has lost its content, or is another program's: "
            f"put a copy of it in its place, or {MOVE_AWAY}."
        )


def refuse_damage(db: sqlite3.Connection) -> None:
    """Raises sqlite3.DatabaseError if the file is not as it was written."""
    if db.execute("PRAGMA integrity_check(1)").fetchone() != ("ok",):
        raise sqlite3.DatabaseError("database disk image is malformed")
    if version(db) == VERSION and not row_sums.are_right(db):
        raise sqlite3.DatabaseError("a row is not as it was written")


def owner(db: sqlite3.Connection) -> str | None:
    """The name of the plant whose memory it is; None for a file older than that entry."""
    found = db.execute("SELECT value FROM fact WHERE fact = ? AND name = ?", OWNER).fetchone()
    return None if found is None else str(found[0])


def boot(db: sqlite3.Connection) -> str | None:
    """The boot of its host on which a plant wrote to it that did not end; None if that plant has ended."""
    found = db.execute("SELECT value FROM fact WHERE fact = ? AND name = ?", BOOT).fetchone()
    return None if found is None else str(found[0])


def refuse_other(db: sqlite3.Connection, path: Path, plant: str) -> None:
    """Raises StartError if it is the memory of another plant."""
    found = owner(db)
    if found not in (None, plant):
        raise StartError(
            f"The plant's memory {path} is of the plant {quoted(found or '')}, and this is {quoted(plant)}:"
            " give this one its own --state directory, or its old name."
        )
