"""Locks of open files, which end with the process that has them, however it ends."""

from __future__ import annotations

import os
from typing import Any

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

FAR = 1 << 30  # byte that is locked where a lock keeps others from reading what it covers


def lock(file: int, *, shared: bool = False) -> bool:
    """Lock an open file if nobody else has it; False if somebody has. `shared` suffers others that share.

    Windows has no shared lock: there a second one who only looks finds the file locked for that moment.
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
