"""Pseudo terminals: serial lines of virtual devices, which Windows does not have."""

from __future__ import annotations

import os

from arboleda.extension import StartError

try:
    import tty
except ImportError:  # Windows
    tty = None  # type: ignore[assignment]


def pseudo_terminal() -> tuple[int, int]:
    """The two ends of a new pseudo terminal, raw: that of the device and that of its client.

    StartError where the system has none.
    """
    if tty is None:
        raise StartError("this system has no pseudo terminals for a serial line of a virtual device")
    device, client = os.openpty()
    os.set_blocking(device, False)
    tty.setraw(client)
    return device, client
