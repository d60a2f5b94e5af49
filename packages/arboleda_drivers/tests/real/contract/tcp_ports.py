"""Ports of a device that a test plays by hand: listeners that keep their numbers, and their clients."""

from __future__ import annotations

import selectors
import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any


class Ports:
    """Listeners that keep their ports, and clients; `told` gets the bytes of each port, by its index."""

    def __init__(
        self,
        count: int,
        told: Callable[[int, bytes], None],
        joined: Callable[[int], None] = lambda port: None,
    ) -> None:
        self._told, self._joined = told, joined
        self.numbers = [0] * count
        self._lock = threading.RLock()
        self._selector: selectors.BaseSelector
        self.open()

    def open(self) -> None:
        listeners = [socket.create_server(("127.0.0.1", number)) for number in self.numbers]
        self.numbers = [each.getsockname()[1] for each in listeners]
        self._clients: list[list[socket.socket]] = [[] for _ in listeners]
        self._selector, self._ending = selectors.DefaultSelector(), threading.Event()
        for which, listener in enumerate(listeners):
            self._selector.register(listener, selectors.EVENT_READ, (which, True))
        self._thread = threading.Thread(target=self._run, name="played ports", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        with self._lock:
            for key in list(self._selector.get_map().values()):
                key.fileobj.close()  # type: ignore[union-attr]
            self._clients = [[] for _ in self.numbers]
            self._selector.close()

    def send(self, which: int, data: bytes) -> None:
        with self._lock:
            for client in self._clients[which]:
                with suppress(OSError):
                    client.sendall(data)

    def _run(self) -> None:
        while not self._ending.is_set():
            for key, _ in self._selector.select(0.05):
                which, listens = key.data
                if listens:
                    self._welcome(key.fileobj, which)
                elif data := self._read(key.fileobj, which):
                    self._told(which, data)

    def _welcome(self, listener: Any, which: int) -> None:
        client, _ = listener.accept()
        with self._lock:
            self._clients[which].append(client)
            self._selector.register(client, selectors.EVENT_READ, (which, False))
        self._joined(which)

    def _read(self, client: Any, which: int) -> bytes:
        with suppress(OSError):
            if data := client.recv(4096):
                return bytes(data)
        with self._lock:
            self._selector.unregister(client)
            self._clients[which].remove(client)
            client.close()
        return b""
