"""Base of virtual controllers over TCP: their ports, their clients, and a thread around their machine."""

from __future__ import annotations

import itertools
import selectors
import socket
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, Protocol

from arboleda.extension import StartError

AT_ONCE = 4096  # bytes
LONGEST_WAIT_S = 0.1


class Machine(Protocol):
    """State machine of a virtual controller."""

    @property
    def next_deadline(self) -> float: ...
    @property
    def is_off(self) -> bool: ...
    def step(self, now: float, events: Sequence[Any]) -> Sequence[Any]: ...


class TcpServer(ABC):
    """Server on several ports, by name, that plays the controller until `stop`; port 0 takes a free one."""

    def __init__(self, machine: Machine, *, kind: str, host: str, ports: Mapping[str, int]) -> None:
        self._began = time.monotonic()
        self._machine, self._host = machine, host
        self._listeners = {name: listen(host, number) for name, number in ports.items()}
        self.ports = {name: each.getsockname()[1] for name, each in self._listeners.items()}
        self._clients: dict[int, tuple[str, socket.socket]] = {}
        self._numbers = itertools.count(1)
        self._selector = selectors.DefaultSelector()
        for name, listener in self._listeners.items():
            listener.setblocking(False)
            self._selector.register(listener, selectors.EVENT_READ, (name, 0))
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"virtual {kind}", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        self._thread.join()
        self._hang_up()
        for listener in self._listeners.values():
            listener.close()
        self._selector.close()

    @abstractmethod
    def _joined(self, client: int, port: str) -> list[Any]:
        """The events of a client that has connected to a port."""

    @abstractmethod
    def _events_of(self, client: int, port: str, data: bytes) -> list[Any]:
        """The events of bytes that a client sent to a port; none: it has hung up."""

    @abstractmethod
    def _do(self, message: Any) -> None:
        """Act on a message of the machine."""

    def _run(self) -> None:
        while not self._ending.is_set():
            now = time.monotonic() - self._began
            wait_s = min(max(0.0, self._machine.next_deadline - now), LONGEST_WAIT_S)
            events = [event for key, _ in self._selector.select(wait_s) for event in self._events(key)]
            for message in self._machine.step(time.monotonic() - self._began, events):
                self._do(message)

    def _events(self, key: selectors.SelectorKey) -> list[Any]:
        port, number = key.data
        assert isinstance(key.fileobj, socket.socket)
        if number == 0:
            return self._welcome(key.fileobj, port)
        try:
            data = key.fileobj.recv(AT_ONCE)
        except OSError:
            data = b""
        if not data:
            self._drop(number)
        return self._events_of(number, port, data)

    def _welcome(self, listener: socket.socket, port: str) -> list[Any]:
        client, _ = listener.accept()
        if self._machine.is_off:
            client.close()
            return []
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        client.settimeout(1.0)
        number = next(self._numbers)
        self._clients[number] = (port, client)
        self._selector.register(client, selectors.EVENT_READ, (port, number))
        return self._joined(number, port)

    def _of_port(self, port: str) -> list[int]:
        """The clients of a port."""
        return [number for number, (name, _) in self._clients.items() if name == port]

    def _send(self, number: int, data: bytes) -> None:
        if number in self._clients:
            with suppress(OSError):  # that it is closed is heard next
                self._clients[number][1].sendall(data)

    def _drop(self, number: int) -> None:
        if number in self._clients:
            _, client = self._clients.pop(number)
            self._selector.unregister(client)
            client.close()

    def _hang_up(self) -> None:
        for number in list(self._clients):
            self._drop(number)


def listen(host: str, port: int) -> socket.socket:
    """Listen on a port; raises StartError, which names it, if that is impossible."""
    try:
        return socket.create_server((host, port))
    except OSError as error:
        why = f"{host}:{port} cannot be listened on: {error}"
        raise StartError(f"{why}; name another port, or 0 for any that is free") from error
