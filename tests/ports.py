"""TCP ports for tests that run side by side."""

from __future__ import annotations

import itertools
import os
import socket
import tempfile
from collections import deque
from pathlib import Path

from arboleda.host.locks import lock
from arboleda.host.machine import own_mark

# Below those of outgoing connections (32768 and up on Linux); each worker begins elsewhere.
PORTS = range(20_000, 32_000)
RESERVATIONS = 64  # more than any test asks for: its own stay its own until it is over
_ports = itertools.cycle([*PORTS[os.getpid() * 37 % len(PORTS) :], *PORTS])
_reservations: deque[int] = deque()


def unused_port(*, in_a_row: int = 1) -> int:
    """A TCP port that nothing has, that the system gives to no outgoing connection meanwhile, and that no
    other worker takes before the test that asked for it has bound it; the first of so many."""
    return next(port for port in _ports if all(map(_is_ours, range(port, port + in_a_row))))


def is_free(port: int) -> bool:
    """True if nothing listens at a TCP port."""
    with socket.socket() as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return False
    return True


def _is_ours(port: int) -> bool:
    return _reserved(port) and is_free(port)


def _reserved(port: int) -> bool:
    """Reserve a port by a lock on a file, as long as this worker lives and few others were asked for."""
    folder = Path(tempfile.gettempdir(), f"arboleda-ports-{own_mark()}")
    folder.mkdir(exist_ok=True)
    file = os.open(folder / str(port), os.O_RDWR | os.O_CREAT)
    if not lock(file):
        os.close(file)
        return False
    _reservations.append(file)
    if len(_reservations) > RESERVATIONS:
        os.close(_reservations.popleft())
    return True
