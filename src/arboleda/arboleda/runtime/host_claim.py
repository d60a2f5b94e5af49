"""Claims that one process of a computer can have at a time, such as to a place in the file system."""

from __future__ import annotations

import hashlib
import os
import socket
import struct
from collections.abc import Callable
from pathlib import Path

from arboleda.host import abilities
from arboleda.model.errors import StartError

HAS_ABSTRACT = abilities.ABSTRACT_SOCKETS  # elsewhere claims always succeed
ASKERS = 64  # processes that may ask for the owner at once; the system answers them
CREDENTIALS = struct.Struct("3i")  # process, user, group


class HostClaim:
    """An abstract socket, named by what is claimed; it is there as long as the process is.

    A name without a file cannot be deleted, and nothing is left of it when its process is killed. It counts
    within one network namespace. `refusal` makes the sentence for who comes second, of the owner as text
    (` (process 7)`, or nothing where the system does not tell it).
    """

    def __init__(self, claimed: str, refusal: Callable[[str], str]) -> None:
        self._name = f"\0arboleda/{hashlib.sha256(os.fsencode(claimed)).hexdigest()}"
        self._refusal = refusal
        self._socket: socket.socket | None = None

    def take(self) -> None:
        """Take the claim; StartError if another has it; idempotent."""
        if self._socket is not None or not HAS_ABSTRACT:
            return
        claim = socket.socket(socket.AF_UNIX)
        try:
            claim.bind(self._name)
            claim.listen(ASKERS)
        except OSError as error:
            claim.close()
            raise StartError(self._refusal(_owner(self._name))) from error
        self._socket = claim

    def release(self) -> None:
        """Give it back; idempotent."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


def place_claim(place: Path) -> HostClaim:
    """A claim to a directory: keeps a second plant out while files there may be gone.

    The lock file of a directory can be deleted, and who makes the directory anew locks another file. The
    claim is one for all ways to write the path, and another in a container with its own root.
    """
    root = os.stat("/")
    return HostClaim(
        f"{root.st_dev} {root.st_ino} {os.path.realpath(place)}",
        lambda owner: (
            f"The plant that was started on {place} still runs{owner}, though its files"
            " there are gone: it ends by itself within seconds; end it if it does not, then start again."
        ),
    )


def node_claim(domain: int, node: str) -> HostClaim:
    """A claim to the full name of a node of ROS 2 in a domain, which two plants of a computer cannot share.

    Discovery finds nodes of other computers, too, but may take longer than a start waits for it.
    """
    return HostClaim(
        f"ROS_DOMAIN_ID {domain} {node}",
        lambda owner: (
            f"another node already commands robots as {node} in ROS domain {domain} of this computer{owner}; "
            "stop it, or give this plant a ROS_DOMAIN_ID of its own"
        ),
    )


def _owner(name: str) -> str:
    """The process that has the claim, if the system tells it."""
    with socket.socket(socket.AF_UNIX) as asker:
        asker.setblocking(False)
        try:
            asker.connect(name)
            credentials = asker.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
        except OSError:
            return ""
    process, _, _ = CREDENTIALS.unpack(credentials)
    return f" (process {process})"
