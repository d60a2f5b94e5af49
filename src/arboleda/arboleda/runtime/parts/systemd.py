"""Notices to systemd that the plant is ready, alive, or ending: the protocol of sd_notify(3)."""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Callable, MutableMapping
from contextlib import suppress

from arboleda.adapters import clock

SOCKET, WATCHDOG_US, WATCHDOG_PID = "NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"
PATIENCE_S = 1.0


class SystemdPart:
    """The last part of a plant that systemd started; `stepped_at` says when the plant made its last step.

    A plant that hangs makes no steps, or does not report them: systemd gets no notice then, and starts it
    anew.
    """

    def __init__(self, address: str, watchdog_s: float | None, stepped_at: Callable[[], float]) -> None:
        self._address = f"\0{address[1:]}" if address.startswith("@") else address
        self._watchdog_s = watchdog_s
        self._stepped_at = stepped_at
        self._ending = threading.Event()
        self._watch = threading.Thread(target=self._live, name="systemd", daemon=True)

    def start(self) -> None:
        self._tell("READY=1")
        if self._watchdog_s is not None:
            self._watch.start()

    def stop(self) -> None:
        """Tell systemd that the plant ends, without waiting for one that hangs in a step."""
        self._ending.set()
        self._tell("STOPPING=1")
        if self._watch.ident is not None and self._watch is not threading.current_thread():
            self._watch.join(PATIENCE_S)

    def _live(self) -> None:
        assert self._watchdog_s is not None
        while not self._ending.wait(self._watchdog_s / 3):
            if clock.seconds() - self._stepped_at() < self._watchdog_s:
                self._tell("WATCHDOG=1")

    def _tell(self, state: str) -> None:
        # A plant works on though nobody hears that it does.
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as out, suppress(OSError):
            out.sendto(state.encode(), self._address)


def systemd_part(
    environment: MutableMapping[str, str], stepped_at: Callable[[], float]
) -> SystemdPart | None:
    """The systemd part, if systemd has started this process and wants notices. Takes the variables out of the
    environment, so that no child of this process speaks for it."""
    address = environment.pop(SOCKET, "")
    watched = environment.pop(WATCHDOG_PID, str(os.getpid())) == str(os.getpid())
    period_us = environment.pop(WATCHDOG_US, "")
    if not address.startswith(("/", "@")):
        return None
    watchdog_s = int(period_us) / 1e6 if watched and period_us.isdecimal() and int(period_us) else None
    return SystemdPart(address, watchdog_s, stepped_at)
