"""Numbers that show that a plant's memory is older than what the plant has told anybody.

The memory counts its changes. Beside it stands a mark: the number of the last change that people may know of.
It is written once that change is durable and before anybody is told, so a memory with a lower number has lost
something. Nobody waits for the disk to have the mark: after a power cut it may be too low, or gone, but never
too high.
"""

from __future__ import annotations

import os
import sqlite3
import threading
import zlib
from contextlib import closing, suppress
from pathlib import Path

from arboleda.host.files import BINARY, pwrite, sync_data, sync_folder
from arboleda.model.errors import StartError

from .memory_file import MOVE_AWAY, VERSION_COUNTS, immutable, read_only, refuse_version, version
from .row_sums import written

OLDER = (
    "The plant's memory {path} is older than what the plant has told ({found} of {told} changes are there):"
    " put {path} and its -wal back as they were, or the last backup by `arboleda restore`; to go on with what"
    " is there, look at the robots, as stop latches and tasks may be missing, then `arboleda backup COPY` and"
    " `arboleda restore COPY`, which keeps what was there beside it."
)
FOREIGN = (
    "The plant's memory {path} is not what the plant has kept (another program has written into it while the"
    " plant ran): put the last backup in its place by `arboleda restore`, or {advice}."
)


class Told:
    """The mark of a memory: `told` is the number of the last change that somebody may know of, `folded` that
    of the last change in the memory's main file, without its log. Callable from any thread."""

    def __init__(self, memory: Path) -> None:
        self.path = memory.with_suffix(".told")
        self._memory = memory
        self._file: int | None = None
        self._reader: sqlite3.Connection | None = None  # a connection of its own: it sees what is committed
        self._writing = threading.Lock()
        self._told, self._folded, self._spoilt = self._read()

    def open(self) -> None:
        """Begin to mark, once the memory is there; raises sqlite3.Error."""
        self._reader = sqlite3.connect(self._memory, isolation_level=None, check_same_thread=False)
        self.number()  # the connection opens the file when it is first used

    def number(self) -> int:
        """The number of the last change that is committed; raises sqlite3.Error."""
        return 0 if self._reader is None else written(self._reader)

    def tell(self, number: int) -> None:
        """Mark a change as told; it is durable."""
        with self._writing:
            self._told = number
            self._write()

    def fold(self) -> None:
        """Mark what the main file has, once all of the log is in it; then a power cut leaves this mark, or a
        later one. Raises sqlite3.Error."""
        number = self._in_main_file()
        with self._writing:
            self._folded = number
            self._write()
            if self._file is not None:
                sync_data(self._file)

    def spoil(self) -> None:
        """Have each start refuse the memory from now on: another program has written into it."""
        with self._writing:
            self._spoilt = True
            self._write()

    def refuse_older(self) -> None:
        """Raises StartError, or sqlite3.Error, if the memory is older than its mark; the memory is only read,
        so that a log which may be put right stays as it is."""
        if self._spoilt:
            raise StartError(FOREIGN.format(path=self._memory, advice=MOVE_AWAY))
        if self._told:
            with closing(read_only(self._memory)) as db:
                self._refuse(self._changes(db), self._told)
            self.refuse_foreign()

    def refuse_foreign(self) -> None:
        """Raises StartError, or sqlite3.Error, if the main file is older than its mark."""
        folded = self._folded
        with suppress(sqlite3.DatabaseError):  # half folded: with its log it is right, which others check
            self._refuse(self._in_main_file(), folded)

    def forget(self) -> None:
        """Remove the mark, durably: another memory comes in the place of this one. Raises OSError."""
        self.path.unlink(missing_ok=True)
        sync_folder(self.path.parent)

    def close(self) -> None:
        if self._reader is not None:
            self._reader.close()
            self._reader = None
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def _refuse(self, found: int, told: int) -> None:
        if found < told:
            raise StartError(OLDER.format(path=self._memory, found=found, told=told))

    def _in_main_file(self) -> int:
        with closing(immutable(self._memory)) as db:
            return self._changes(db)

    def _changes(self, db: sqlite3.Connection) -> int:
        """The number of the last change that a connection sees; 0 in a format that counts none."""
        refuse_version(db, self._memory)
        return written(db) if version(db) >= VERSION_COUNTS else 0

    def _read(self) -> tuple[int, int, bool]:
        """The content of the mark; zeros if there is none, or a power cut has left half of one."""
        with suppress(OSError, ValueError):
            words, _, checksum = self.path.read_bytes().rpartition(b" ")
            if zlib.crc32(words) == int(checksum, 16):
                told, folded, spoilt = map(int, words.split())
                return told, folded, bool(spoilt)
        return 0, 0, False

    def _write(self) -> None:
        """Write the mark by one call, always of one length. Where that fails the mark is too low, which does
        no harm."""
        words = b"%020d %020d %d" % (self._told, self._folded, self._spoilt)
        with suppress(OSError):
            if self._file is None:
                self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | BINARY, 0o600)
            pwrite(self._file, b"%s %08x" % (words, zlib.crc32(words)), 0)
