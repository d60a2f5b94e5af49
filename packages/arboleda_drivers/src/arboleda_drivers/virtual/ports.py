"""Ports that virtual controllers listen on."""

from __future__ import annotations

import socket

from arboleda.extension import StartError


def listen(host: str, port: int) -> socket.socket:
    """Listen on a port; raises StartError, which names it, if that is impossible."""
    try:
        return socket.create_server((host, port))
    except OSError as error:
        why = f"{host}:{port} cannot be listened on: {error}"
        raise StartError(f"{why}; name another port, or 0 for any that is free") from error
