"""Watch over files that this process keeps open: finds those that their paths no longer lead to."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

ABSENT = (FileNotFoundError, NotADirectoryError)
GONE, OTHER = "was deleted or moved away", "was replaced by another file"


@dataclass(frozen=True, kw_only=True)
class Loss:
    """Open file that is no longer in its place, and its fate."""

    path: Path
    fate: str

    def __str__(self) -> str:
        return f"{self.path} {self.fate} while the plant ran"


class HeldFiles:
    """Device and inode of each file as it was opened, against what its path leads to now; from any thread.

    A file that is open can be written long after its name is gone, and all of that is lost with the process.
    As long as it is open no other file gets its inode.
    """

    def __init__(self, paths: Iterable[Path] = ()) -> None:
        found = {str(path): _identity(str(path)) for path in paths}
        self._held = {path: opened for path, opened in found.items() if opened is not None}

    def loss(self) -> Loss | None:
        """The first file that is not in its place; None if all are there."""
        for path, opened in self._held.items():
            try:  # here and not in a function: it is read before each command
                found = os.stat(path)
            except ABSENT:
                return Loss(path=Path(path), fate=GONE)
            if (found.st_dev, found.st_ino) != opened:
                return Loss(path=Path(path), fate=OTHER)
        return None


def _identity(path: str) -> tuple[int, int] | None:
    """Device and inode of the file at a path; None without one."""
    try:
        found = os.stat(path)
    except ABSENT:
        return None
    return found.st_dev, found.st_ino
