"""File of the facts of one step: written before its commands leave, and committed right after."""

from __future__ import annotations

import os
import zlib
from ast import literal_eval
from collections.abc import Sequence
from operator import attrgetter
from pathlib import Path

from arboleda.host.files import BINARY, pwrite
from arboleda.model.messages import Fact, Remember

ROW = attrgetter("fact._value_", "name", "value")
LENGTH, SUM = 4, 4  # bytes before the text
NOTHING = bytes(LENGTH + SUM)


class Ahead:
    """Facts that a killed process leaves to the next start; what was written on another `boot` of the host
    counts as lost with its power.

    `read`, `clear` and `close` raise OSError.
    """

    def __init__(self, path: Path, boot: str) -> None:
        self.path = path
        self._boot = boot
        self._file: int | None = None

    def takes(self, facts: Sequence[Remember]) -> bool:
        """Write facts in the place of those before; False if it cannot, as where the disk is full.

        They survive a killed process, not a power cut.
        """
        text = repr((self._boot, [*map(ROW, facts)])).encode()  # made by one call, where JSON takes several
        words = len(text).to_bytes(LENGTH, "big") + zlib.crc32(text).to_bytes(SUM, "big") + text
        try:
            if self._file is None:
                self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | BINARY, 0o644)
            return pwrite(self._file, words, 0) == len(words)
        except OSError:
            return False

    def read(self) -> list[Remember]:
        """The facts that were not committed; none if the file was not written as a whole."""
        text = self._text()
        if not text:
            return []
        boot, rows = literal_eval(text.decode())
        facts = [Remember(fact=Fact(fact), name=name, value=value) for fact, name, value in rows]
        return facts if boot == self._boot else []

    def is_damaged(self) -> bool:
        """True if the file is not as a process leaves it, killed or not; a power cut may have done that."""
        return self._text() is None

    def _text(self) -> bytes | None:
        """The note, b"" if there is none; None if it is not there as a whole."""
        try:
            words = self.path.read_bytes()
        except FileNotFoundError:
            return b""
        length = int.from_bytes(words[:LENGTH], "big")
        text = words[LENGTH + SUM :][:length]
        is_whole = len(text) == length and zlib.crc32(text).to_bytes(SUM, "big") == words[LENGTH:][:SUM]
        return text if is_whole or not words else None

    def clear(self) -> None:
        """Forget the facts: they are committed. Before the first are written the file itself goes."""
        if self._file is not None:
            pwrite(self._file, NOTHING, 0)
        else:
            self.path.unlink(missing_ok=True)

    def close(self) -> None:
        """Remove the file, unless it holds what was not committed, or is another plant's; idempotent."""
        if self._file is None:
            return
        mine, self._file = self._file, None
        try:
            is_over = not self.read() and os.path.samestat(os.fstat(mine), os.stat(self.path))
        finally:
            os.close(mine)
        if is_over:  # Windows removes no open file
            self.path.unlink()
