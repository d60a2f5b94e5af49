"""Locks of open files, which end with the process that has them, however it ends."""

from __future__ import annotations

import os
from typing import Any

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

FAR = 1 << 30  # byte that is locked on Windows, where nobody can read a locked byte


def lock(file: int, *, shared: bool = False) -> bool:
    """Lock an open file; False if another process has locked it. Several processes can have a `shared` lock.

    Windows has no shared lock: there a second reader finds the file locked for a moment.
    """
    if fcntl is None:
        return _lock_byte(file)
    try:
        fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _lock_byte(file: int) -> bool:
    import msvcrt

    windows: Any = msvcrt  # whose functions are declared on Windows alone
    os.lseek(file, FAR, os.SEEK_SET)
    try:
        windows.locking(file, windows.LK_NBLCK, 1)
    except OSError:
        return False
    return True
