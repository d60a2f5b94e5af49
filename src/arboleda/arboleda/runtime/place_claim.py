"""The claim to a place in the file system: keeps a second plant out while files there may be gone."""

from __future__ import annotations

import hashlib
import os
import socket
import struct
import sys
from pathlib import Path

from arboleda.model.errors import StartError

HAS_ABSTRACT = sys.platform == "linux"  # elsewhere the lock alone keeps plants apart
ASKERS = 64  # processes that may ask for the owner at once; the system answers them
CREDENTIALS = struct.Struct("3i")  # process, user, group


class PlaceClaim:
    """An abstract socket, named by the path of a directory; it is there as long as the process is.

    The lock file of a directory can be deleted, and who makes the directory anew locks another file. A name
    without a file cannot be deleted. It counts within one network namespace and one root of the file system.
    """

    def __init__(self, place: Path) -> None:
        self._place = place
        self._socket: socket.socket | None = None

    def take(self) -> None:
        """Take the place; StartError if another process has it; idempotent."""
        if self._socket is not None or not HAS_ABSTRACT:
            return
        name = _name(self._place)
        claim = socket.socket(socket.AF_UNIX)
        try:
            claim.bind(name)
            claim.listen(ASKERS)
        except OSError as error:
            claim.close()
            raise StartError(
                f"The plant that was started on {self._place} still runs{_owner(name)}, though its files"
                " there are gone: it ends by itself within seconds; end it if it does not, then start again."
            ) from error
        self._socket = claim

    def release(self) -> None:
        """Give the place back; idempotent."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


def _name(place: Path) -> str:
    """The socket's name: one for all ways to write the path, another in a container with its own root."""
    root = os.stat("/")
    what = f"{root.st_dev} {root.st_ino} {os.path.realpath(place)}"
    return f"\0arboleda/{hashlib.sha256(os.fsencode(what)).hexdigest()}"


def _owner(name: str) -> str:
    """The process that has the place, if the system tells it."""
    with socket.socket(socket.AF_UNIX) as asker:
        asker.setblocking(False)
        try:
            asker.connect(name)
            told = asker.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
        except OSError:
            return ""
    process, _, _ = CREDENTIALS.unpack(told)
    return f" (process {process})"
