"""Serial line of a virtual device: a pseudo terminal, and a thread around the machine behind it."""

from __future__ import annotations

import os
import select
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from arboleda.extension import StartError

try:
    import tty
except ImportError:  # Windows
    tty = None  # type: ignore[assignment]

AT_ONCE = 4096
LONGEST_WAIT_S = 0.05


class LineMachine(Protocol):
    """Machine at the far end of a line."""

    @property
    def next_deadline(self) -> float:
        """The time at which `step` is due even without bytes."""

    @property
    def is_unplugged(self) -> bool:
        """True while there is no line."""

    def step(self, now: float, data: bytes = b"") -> bytes:
        """Let time pass, take bytes from the line, and return those that come back."""


class PtyLine:
    """Pseudo terminal before a machine until `stop`; `link` is its name for clients, "" for none.

    While the machine is unplugged there is no terminal; then there is a new one, at the same link.
    """

    def __init__(self, machine: LineMachine, *, link: str = "", what: str = "a virtual device") -> None:
        self.machine = machine
        self._link, self._what = Path(link) if link else None, what
        self._began = time.monotonic()
        self._master = self._slave = -1
        self._woken, self._waker = os.pipe()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name=what, daemon=True)
        if self._link is not None and self._link.exists() and not self._link.is_symlink():
            raise StartError(f"{self._link} is there and no link; name another one with --link")
        self._plug()

    @property
    def path(self) -> str:
        """The name of the line for a client."""
        return str(self._link or os.ttyname(self._slave))

    @property
    def says(self) -> str:
        return f"{self._what} is on the line {self.path}"

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        os.write(self._waker, b"!")
        self._thread.join()
        self._unplug()
        for each in (self._woken, self._waker):
            os.close(each)

    def _run(self) -> None:
        while not self._ending.is_set():
            wait_s = min(max(0.0, self.machine.next_deadline - self._now), LONGEST_WAIT_S)
            data = self._read(wait_s)
            answer = self.machine.step(self._now, data)
            if self.machine.is_unplugged:
                self._unplug()
            elif self._master < 0:
                self._plug()
            elif answer:
                with suppress(OSError):  # nobody reads
                    os.write(self._master, answer)

    @property
    def _now(self) -> float:
        return time.monotonic() - self._began

    def _read(self, wait_s: float) -> bytes:
        lines = [self._woken] if self._master < 0 else [self._woken, self._master]
        ready, _, _ = select.select(lines, [], [], wait_s)
        with suppress(OSError):  # the client has hung up
            return os.read(self._master, AT_ONCE) if self._master in ready else b""
        return b""

    def _plug(self) -> None:
        self._master, self._slave = pseudo_terminal()  # the slave stays open here, or the master hangs up
        if self._link is not None:
            with suppress(FileNotFoundError):
                self._link.unlink()
            self._link.symlink_to(os.ttyname(self._slave))

    def _unplug(self) -> None:
        if self._master < 0:
            return
        if self._link is not None:
            with suppress(FileNotFoundError):
                self._link.unlink()
        os.close(self._slave)
        os.close(self._master)
        self._master = self._slave = -1


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
