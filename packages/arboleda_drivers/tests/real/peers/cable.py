"""A cable between a driver and a peer, that is cut and mended: a port, and a port or a line behind it."""

from __future__ import annotations

import os
import select
import socket
import struct
import termios
import threading
from collections.abc import Callable
from contextlib import suppress

ONES = 4096
RESET = struct.pack("ii", 1, 0)  # a connection that ends at once, with all that was on its way


def at_port(port: int) -> Callable[[], int]:
    """A function that opens the far end at a port of this machine."""
    return lambda: socket.create_connection(("127.0.0.1", port)).detach()


def at_line(device: int) -> Callable[[], int]:
    """A function that opens the far end at a pseudo terminal, without what a client before has left in it."""

    def opened() -> int:
        termios.tcflush(device, termios.TCIOFLUSH)
        return os.dup(device)

    return opened


class Cable:
    """It passes bytes on from its `port` until `close`; whatever else has these words can stand in its place.

    While it is cut nobody listens at the port and connections are reset. A silent cut is that of a network:
    what is sent meanwhile arrives once it is mended, also from who has closed its connection and not
    reset it. What was opened meanwhile is reset then.
    """

    def __init__(self, far: Callable[[], int]) -> None:
        self._far = far
        self._lock = threading.Lock()
        self._ends: dict[
            int, int
        ] = {}  # each end of a connection to the other one; its own where there is none
        self._is_silent = False
        self._woken, self._waker = os.pipe()
        self._listener: socket.socket | None = None
        self.port = 0
        self._listen()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="cable", daemon=True)
        self._thread.start()

    def cut(self, *, silent: bool) -> None:
        with self._lock:
            self._is_silent = silent
            if not silent:
                self._deafen()
                self._reset_all()
        self._wake()

    def mend(self) -> None:
        with self._lock:
            if self._is_silent:
                self._is_silent = False
                self._reset_dead()
            if self._listener is None:
                self._listen()
        self._wake()

    def close(self) -> None:
        self._ending.set()
        self._wake()
        self._thread.join()
        self._deafen()
        self._reset_all()
        os.close(self._woken)
        os.close(self._waker)

    def _listen(self) -> None:
        self._listener = socket.create_server(("127.0.0.1", self.port))
        self.port = self._listener.getsockname()[1]

    def _deafen(self) -> None:
        if self._listener is not None:
            self._listener.close()
            self._listener = None

    def _wake(self) -> None:
        os.write(self._waker, b"!")

    def _run(self) -> None:
        while not self._ending.is_set():
            with self._lock:
                listening = [] if self._listener is None else [self._listener.fileno()]
                ends = [] if self._is_silent else [*self._ends]
            with suppress(OSError):  # one of them was closed in this moment
                ready, _, _ = select.select([self._woken, *listening, *ends], [], [])
                if self._woken not in ready:
                    self._serve(ready)
                    continue
            os.read(self._woken, ONES)  # what was ready may be gone

    def _serve(self, ready: list[int]) -> None:
        with self._lock:
            for each in ready:
                if each in self._ends:
                    self._pass_on(each)
                elif self._listener is not None and each == self._listener.fileno():
                    self._join()

    def _join(self) -> None:
        assert self._listener is not None
        near, _ = self._listener.accept()
        near.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        here = near.detach()
        try:
            there = here if self._is_silent else self._far()
        except OSError:  # the peer is not there
            reset(here)
            return
        self._ends[here], self._ends[there] = there, here

    def _pass_on(self, end: int) -> None:
        other = self._ends[end]
        try:
            data = os.read(end, ONES)
            if data:
                os.write(other, data)
        except OSError:
            self._end(end, reset)
            return
        if not data:
            self._end(end, os.close)

    def _end(self, end: int, close: Callable[[int], None]) -> None:
        for each in {end, self._ends[end]}:
            del self._ends[each]
            close(each)

    def _reset_dead(self) -> None:
        """Reset what was reset or opened during a silent cut: nothing of that arrives."""
        for end in [*self._ends]:
            if end in self._ends and (self._ends[end] == end or was_reset(end)):
                self._end(end, reset)

    def _reset_all(self) -> None:
        while self._ends:
            self._end(next(iter(self._ends)), reset)


def was_reset(end: int) -> bool:
    """True for a connection that the other side has reset."""
    looks = select.poll()
    looks.register(end, 0)
    return any(seen & select.POLLERR for _, seen in looks.poll(0))


def reset(end: int) -> None:
    """Close an end; a connection is reset."""
    try:
        connection = socket.socket(fileno=end)
    except OSError:  # a line
        os.close(end)
        return
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
    connection.close()
