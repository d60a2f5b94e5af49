"""Signals that not every system has, and the terminal of this process."""

from __future__ import annotations

import os
import signal
from contextlib import suppress

HANG_UP: int | None = getattr(signal, "SIGHUP", None)  # None: this system has no such signal
TERMINAL = "/dev/tty"


def has_terminal() -> bool:
    """True if this process has a terminal of its own that is still there."""
    try:
        os.close(os.open(TERMINAL, os.O_RDONLY | getattr(os, "O_NOCTTY", 0)))
    except OSError:
        return False
    return True


def kill_group(process: int) -> None:
    """Kill a process that began a session of its own, with all that it started; nothing if it has ended.

    Where the system has no groups of processes, only this process ends.
    """
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError):
            os.killpg(process, signal.SIGKILL)
        return
    with suppress(OSError):  # Windows refuses it for one that has ended
        os.kill(process, signal.SIGTERM)
