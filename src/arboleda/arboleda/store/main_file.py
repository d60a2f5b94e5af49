"""Watch over the main file of a plant's memory: only folding writes into it, and other programs must not."""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing, suppress
from pathlib import Path

from arboleda.model.errors import ArboledaError

from .memory_file import MOVE_AWAY, SPOILT, read_only, refuse_damage, refuse_version
from .told_number import FOREIGN, Told


class MainFile:
    """Main file as it is after each folding of its log. What else changes it is checked as at a start.

    One thread folds, another may look.
    """

    def __init__(self, path: Path, told: Told) -> None:
        self._path = path
        self._told = told
        self._folds = False
        self._known = self._stamp()

    def fold(self, db: sqlite3.Connection) -> None:
        """Bring the log into the file, unless another program has written into that; raises sqlite3.Error."""
        if self._stamp() != self._known:
            return
        self._folds = True
        try:
            _, in_log, in_file = db.execute("PRAGMA wal_checkpoint(PASSIVE)").fetchone()
            if in_log == in_file:
                self._told.fold()
            self._known = self._stamp()
        finally:
            self._folds = False

    def look(self) -> None:
        """Raises ArboledaError if another program has changed the content of the file. Reads all of it where
        something else than `fold` has written."""
        found = self._stamp()
        if found == self._known or self._folds:
            return
        try:
            self._told.refuse_foreign()
            with closing(read_only(self._path)) as db:
                refuse_version(db, self._path)
                refuse_damage(db)
        except sqlite3.OperationalError:  # it cannot be read now, which says nothing of its content
            return
        except (ArboledaError, *SPOILT) as error:
            self._told.spoil()
            raise ArboledaError(FOREIGN.format(path=self._path, advice=MOVE_AWAY)) from error
        self._known = found

    def _stamp(self) -> tuple[int, int]:
        """Size and time of the last change; zeros without a file, which others find."""
        with suppress(OSError):
            found = os.stat(self._path)
            return found.st_size, found.st_mtime_ns
        return 0, 0
