"""Relays of real lines: a driver reaches its device through one, over TCP or a pseudo terminal.

A relay has a thread of its own, and a `Line` that says what arrives and when, with the time of a real clock.
"""

from __future__ import annotations

import os
import pty
import select
import socket
import threading
import time
import tty
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from random import Random

from .line import CUT, Form, Line

LONGEST_WAIT_S = 0.05  # until a form that has begun or ended meanwhile is noticed
READ = 65536


@dataclass(frozen=True)
class Chunk:
    """Bytes as they came."""

    data: bytes


class Relay(ABC):
    """Relay between a driver and its device; a context in which it passes what they say."""

    def __init__(self) -> None:
        self.line = Line(Random(0))
        self._lock = threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bad line", daemon=True)
        self._near: int | None = None  # to the driver
        self._far: int | None = None  # to the device

    def __enter__(self) -> Relay:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        self._thread.join()
        self._hang_up()
        self.close()

    @contextmanager
    def bad(self, form: Form) -> Iterator[None]:
        """Context in which the line is bad."""
        with self._lock:
            self.line.begin(form)
        try:
            yield
        finally:
            with self._lock:
                self.line.end()

    def cut(self) -> None:
        """End the connection."""
        with self._lock:
            self.line.broken()
            self._hang_up()

    @abstractmethod
    def close(self) -> None:
        """End what the driver connects to."""

    @abstractmethod
    def _connect(self) -> None:
        """Connect both sides if the driver wants to, and note it; at once where it does not."""

    @abstractmethod
    def _hang_up(self) -> None:
        """End both connections, if there are any."""

    def _run(self) -> None:
        while not self._ending.is_set():
            with self._lock:
                self._connect()
                self._pass()
                watched = [each for each in (self._near, self._far) if each is not None]
                wait_s = min(LONGEST_WAIT_S, max(0.0, self.line.next_deadline - time.monotonic()))
            if not watched:
                time.sleep(wait_s)
                continue
            with suppress(OSError, ValueError):  # it was cut meanwhile
                ready, _, _ = select.select(watched, [], [], wait_s)
                with self._lock:
                    for fd in ready:
                        self._read(fd)

    def _read(self, fd: int) -> None:
        if fd not in (self._near, self._far):
            return
        try:
            data = os.read(fd, READ)
        except OSError:
            data = b""
        now = time.monotonic()
        if not data:
            self.line.closed()
            self._pass()
            self._hang_up()
        elif fd == self._near:
            self.line.asks(now, Chunk(data))
            self.line.echoes(now, Chunk(data))
        else:
            self.line.answers(now, Chunk(data))

    def _pass(self) -> None:
        now = time.monotonic()
        with suppress(OSError):
            for asked in self.line.sent(now):
                _write(self._far, asked.data)
            for answer in self.line.arrived(now):
                if answer is CUT:
                    self._hang_up()
                else:
                    _write(self._near, answer.data)


def _write(fd: int | None, data: bytes) -> None:
    while fd is not None and data:
        data = data[os.write(fd, data) :]


class TcpRelay(Relay):
    """Relay that listens at `port` of this computer, for a device at another port."""

    def __init__(self, to: int, host: str = "127.0.0.1") -> None:
        super().__init__()
        self._to = (host, to)
        self._listening = socket.create_server((host, 0))
        self.port: int = self._listening.getsockname()[1]
        self._sockets: list[socket.socket] = []

    def close(self) -> None:
        self._listening.close()

    def _connect(self) -> None:
        if not select.select([self._listening], [], [], 0.0)[0]:
            return
        self._hang_up()
        near, _ = self._listening.accept()
        try:
            far = socket.create_connection(self._to)
        except OSError:
            near.close()
            return
        for each in (near, far):
            each.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._sockets, self._near, self._far = [near, far], near.fileno(), far.fileno()
        self.line.opened(time.monotonic())

    def _hang_up(self) -> None:
        for each in self._sockets:
            each.close()
        self._sockets, self._near, self._far = [], None, None


class PtyRelay(Relay):
    """Relay at the pseudo terminal `path`, for a device at another one."""

    def __init__(self, to: str) -> None:
        super().__init__()
        self._near, self._slave = pty.openpty()
        tty.setraw(self._near)
        tty.setraw(self._slave)
        self.path = os.ttyname(self._slave)
        self._far = os.open(to, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self._far)

    def close(self) -> None:
        for each in (self._near, self._slave, self._far):
            if each is not None:
                os.close(each)
        self._near = self._far = None

    def _connect(self) -> None:
        """A pseudo terminal is there all the time."""

    def _hang_up(self) -> None:
        """A serial line has no connection to end."""
