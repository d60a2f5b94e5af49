"""Files that this process keeps open: says which of them its path leads to no more."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

GONE, OTHER = "was deleted or moved away", "was replaced by another file"


@dataclass(frozen=True, kw_only=True)
class Loss:
    """A file that is not in its place, and what became of it."""

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
        """The first file that is not in its place; None where all are there."""
        for path, opened in self._held.items():
            now = _identity(path)
            if now != opened:
                return Loss(path=Path(path), fate=GONE if now is None else OTHER)
        return None


def _identity(path: str) -> tuple[int, int] | None:
    """None where there is nothing; what else the system refuses, the next write says."""
    try:
        found = os.stat(path)
    except (FileNotFoundError, NotADirectoryError):
        return None
    return found.st_dev, found.st_ino
