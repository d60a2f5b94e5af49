"""Connections that end abruptly: what has not arrived when one is closed never does."""

from __future__ import annotations

import os
import socket
import struct

AT_ONCE = struct.pack("hh" if os.name == "nt" else "ii", 1, 0)


def end_abruptly(connection: socket.socket) -> None:
    """Have this connection end at once when it is closed.

    Without that the system goes on sending for minutes: once a pulled cable is back, an order arrives that
    its task has given up.
    """
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, AT_ONCE)
