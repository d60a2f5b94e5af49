"""A copy of a plant's memory, made while the plant runs or not, and its way back."""

from __future__ import annotations

import os
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path

from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.outside import quoted

from .memory_file import (
    BUSY_S,
    MOVE_AWAY,
    SPOILT,
    advice,
    explained,
    in_words,
    owner,
    read_only,
    refuse_damage,
    refuse_other,
    refuse_version,
    version,
)
from .sqlite import Store
from .task_rows import TaskQuery
from .told_number import Told

BESIDE = ("-wal", "-shm", "-journal", "-ahead")


def back_up(memory: Path, copy: Path, plant: str = "") -> None:
    """Copy a plant's memory as it is at one moment, while the plant may write it.

    StartError where there is none, where it cannot be used, where the copy exists or cannot be written, and
    where it is of another plant than `plant`.
    """
    if not memory.exists():
        raise StartError(f"There is no plant's memory {memory}; a plant makes it when it starts.")
    with explained(memory, StartError, "cannot be copied"), closing(read_only(memory)) as source:
        _begin(source, memory)
        if plant:
            refuse_other(source, memory, plant)
        _copy(source, copy)


@contextmanager
def opened(copy: Path) -> Iterator[sqlite3.Connection]:
    """A backup to restore; StartError where it is none, or is damaged or of a newer Arboleda."""
    if not copy.exists():
        raise StartError(f"{copy} does not exist.")
    try:
        with closing(read_only(copy)) as source:
            _begin(source, copy)
            yield source
    except SPOILT as error:
        raise StartError(f"{copy} is no backup of a plant's memory ({in_words(error)}).") from error
    except StartError as error:
        raise StartError(str(error).replace(f", or {MOVE_AWAY}", "")) from error


def restore(source: sqlite3.Connection, copy: Path, memory: Path, plant: str = "") -> None:
    """Put an `opened` copy in the place of a plant's memory, which is kept beside it as `.before-restore`.

    The plant must not run. StartError, and all is as before, where it cannot be written, where another
    program uses it, or where the copy is of another plant than `plant`, or than the memory that is there.
    """
    _refuse_other(owner(source), copy, plant)
    fresh = memory.with_name(f".{memory.name}.restored")
    _forget(fresh)
    try:
        _refuse_other(owner(source), copy, _fold(memory))
        _copy(source, fresh)
        with Store(fresh) as restored:  # raises an error if it is damaged, and brings it up to date
            restored.tasks.select(TaskQuery(limit=1))
        with explained(memory, StartError, "cannot be replaced"):
            _set_aside(memory)
            fresh.replace(memory)
            Told(memory).forget()  # a backup is older on purpose
    except ArboledaError as error:
        raise StartError(str(error).replace(str(fresh), str(copy))) from error
    finally:
        _forget(fresh)


def _begin(source: sqlite3.Connection, path: Path) -> None:
    """Begin to read the memory; raises an error, without waiting, if another program has locked it."""
    source.execute("BEGIN")
    refuse_version(source, path)
    refuse_damage(source)


def _copy(source: sqlite3.Connection, copy: Path) -> None:
    """Make a new file and fill it; raises StartError, and leaves no file, if that is impossible."""
    try:
        with copy.open("xb"):
            pass
    except FileExistsError as error:
        raise StartError(f"{copy} exists already; give the backup another name.") from error
    except OSError as error:
        raise StartError(f"{copy} cannot be written: {error.strerror}.") from error
    try:
        with closing(sqlite3.connect(copy)) as target:
            source.backup(target)
            refuse_damage(target)
            target.execute("PRAGMA journal_mode = DELETE")  # one file, which a read-only medium can hold
    except sqlite3.Error as error:
        _forget(copy)
        raise StartError(
            f"{copy} cannot be written ({in_words(error)}): make room there, and try again."
        ) from error
    except BaseException:  # Ctrl-C too leaves no half of a copy
        _forget(copy)
        raise


def _refuse_other(found: str | None, copy: Path, plant: str | None) -> None:
    if found and plant and found != plant:
        raise StartError(
            f"{copy} is of the plant {quoted(found)}, and this is {quoted(plant)}: name the directory of that"
            " plant with --state."
        )


def _fold(memory: Path) -> str | None:
    """Merge a memory and its log into one file, unless it is too damaged; returns the plant's name.

    None: there is no memory, or its owner is unknown. Raises StartError if another program uses it. What has
    lost something stays as it is: folding would delete the rest of a damaged log.
    """
    if not memory.exists():
        return None
    try:
        Told(memory).refuse_older()
    except (StartError, *SPOILT):
        return None
    try:
        with closing(sqlite3.connect(memory, timeout=BUSY_S, isolation_level=None)) as db:
            if version(db) == 0:
                return None
            db.execute("BEGIN IMMEDIATE")
            db.execute("COMMIT")
            db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
            return owner(db)
    except SPOILT as error:
        if "locked" in str(error):
            why = f"({error}): {advice(str(error))}"
            raise StartError(f"The plant's memory {memory} cannot be replaced {why}.") from error
        return None


def _set_aside(memory: Path) -> None:
    """Keep the present memory under another name, too; then only its one file is left in its place."""
    before = f"{memory.name}.before-restore"
    _forget(memory.with_name(before))
    for end in ("", *BESIDE):
        path = Path(f"{memory}{end}")
        if path.exists():
            _keep_beside(path, path.with_name(f"{before}{end}"))
    for end in BESIDE:
        Path(f"{memory}{end}").unlink(missing_ok=True)


def _keep_beside(path: Path, name: Path) -> None:
    try:
        os.link(path, name)
    except OSError:  # not every file system has links
        shutil.copy2(path, name)


def _forget(path: Path) -> None:
    for end in ("", *BESIDE):
        with suppress(OSError):
            Path(f"{path}{end}").unlink(missing_ok=True)
