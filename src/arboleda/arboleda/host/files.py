"""Files: flags for opening them, and writes that outlast a power cut."""

from __future__ import annotations

import os
from pathlib import Path

# Without O_NONBLOCK, opening a pipe waits until somebody stands at its other end; Windows opens none by name.
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0)
BINARY = getattr(os, "O_BINARY", 0)  # Windows writes other ends of lines without it
sync_data = getattr(os, "fdatasync", os.fsync)  # only some systems can sync data without metadata


def _pwrite(file: int, content: bytes, at: int) -> int:
    os.lseek(file, at, os.SEEK_SET)
    return os.write(file, content)


pwrite = getattr(os, "pwrite", _pwrite)  # two calls are as good for a file that only one thread has open


def sync_folder(folder: Path) -> None:
    """Have a new entry of a folder outlast a power cut; nothing on Windows, which cannot open folders."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(opened)
    finally:
        os.close(opened)


def write_anew(file: int, content: bytes) -> None:
    """Replace the content of an open file."""
    os.ftruncate(file, 0)
    pwrite(file, content, 0)
