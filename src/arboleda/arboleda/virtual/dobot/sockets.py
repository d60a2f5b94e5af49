"""Ports of a virtual Dobot: dashboard, feedback, and a thread around the machine."""

from __future__ import annotations

import itertools
import selectors
import socket
import threading
import time
from collections.abc import Callable, Collection
from contextlib import suppress

from ..ports import listen
from .machine import Answer, ClientText, Disconnect, Frame, Message, VirtualDobot

AT_ONCE = 4096  # bytes
LONGEST_WAIT_S = 0.1
DASHBOARD, FEEDBACK, HEARD = "dashboard", "feedback", "heard"


class Server:
    """Server on both ports that plays the controller until `stop`; port 0 takes a free one."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        feedback_port: int = 0,
        enabled: bool = False,
        make: Callable[..., VirtualDobot] = VirtualDobot,
    ) -> None:
        self._began = time.monotonic()
        self.machine = make(faults, enabled=enabled, unix_s=time.time())
        self._listeners = {DASHBOARD: listen(host, port), FEEDBACK: listen(host, feedback_port)}
        self.port, self.feedback_port = (each.getsockname()[1] for each in self._listeners.values())
        self._host = host
        self._clients: dict[int, socket.socket] = {}
        self._fed: set[socket.socket] = set()
        self._numbers = itertools.count(1)
        self._selector = selectors.DefaultSelector()
        for what, listener in self._listeners.items():
            listener.setblocking(False)
            self._selector.register(listener, selectors.EVENT_READ, (what, 0))
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="virtual dobot", daemon=True)

    @property
    def says(self) -> str:
        ports = f"dashboard {self.port}, feedback {self.feedback_port}"
        return f"a virtual Dobot CR10A listens on {self._host}: {ports}"

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        self._thread.join()
        self._hang_up()
        for listener in self._listeners.values():
            listener.close()
        self._selector.close()

    def _run(self) -> None:
        while not self._ending.is_set():
            now = time.monotonic() - self._began
            wait_s = min(max(0.0, self.machine.next_deadline - now), LONGEST_WAIT_S)
            said = [event for key, _ in self._selector.select(wait_s) for event in self._heard(key)]
            for message in self.machine.step(time.monotonic() - self._began, said):
                self._do(message)

    def _heard(self, key: selectors.SelectorKey) -> list[ClientText]:
        what, number = key.data
        assert isinstance(key.fileobj, socket.socket)
        if what != HEARD:
            self._welcome(key.fileobj, what)
            return []
        try:
            data = key.fileobj.recv(AT_ONCE)
        except OSError:
            data = b""
        if not data:
            self._forget(key.fileobj, number)
            return []
        text = data.decode("utf-8", "replace")
        return [ClientText(client=number, text=text)] if number in self._clients else []

    def _welcome(self, listener: socket.socket, what: str) -> None:
        client, _ = listener.accept()
        if self.machine.is_off:
            client.close()
            return
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        client.settimeout(1.0)
        number = next(self._numbers)
        if what == DASHBOARD:
            self._clients[number] = client
        else:
            self._fed.add(client)
        self._selector.register(client, selectors.EVENT_READ, (HEARD, number))

    def _do(self, message: Message) -> None:
        if isinstance(message, Disconnect):
            self._hang_up()
        elif isinstance(message, Frame):
            for client in list(self._fed):
                self._send(client, message.data)
        elif isinstance(message, Answer) and message.client in self._clients:
            self._send(self._clients[message.client], message.text.encode())

    def _send(self, client: socket.socket, data: bytes) -> None:
        with suppress(OSError):  # that it is closed is heard next
            client.sendall(data)

    def _forget(self, client: socket.socket, number: int) -> None:
        self._clients.pop(number, None)
        self._fed.discard(client)
        self._selector.unregister(client)
        client.close()

    def _hang_up(self) -> None:
        for key in list(self._selector.get_map().values()):
            if key.data[0] == HEARD:
                assert isinstance(key.fileobj, socket.socket)
                self._forget(key.fileobj, key.data[1])
