"""Boot of this host: tells a start whose process was killed from one whose host had lost its power."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

LINUX = Path("/proc/sys/kernel/random/boot_id")


def this_boot() -> str:
    """A name of the time since the host was switched on; another one each time where nobody can tell."""
    try:
        return LINUX.read_text("ascii").strip()
    except OSError:
        return f"unknown {uuid4()}"
