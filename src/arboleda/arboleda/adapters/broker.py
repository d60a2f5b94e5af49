"""The broker that comes with the plant: amqtt in a thread of its own."""

from __future__ import annotations

import asyncio
import errno
import ipaddress
import logging
import secrets
import socket
import threading
from collections.abc import Mapping
from concurrent.futures import Future
from typing import Any

from arboleda.core.errors import StartError

from .guarded_broker import Access, GuardedBroker
from .mqtt import Address, Credentials

log = logging.getLogger(__name__)

TRUSTED = "arboleda"
STOP_S = 3.0


class EmbeddedBroker:
    """An MQTT 3.1.1 broker on `host:port` (0: any free port).

    Without `users` anybody on this machine may use it. With users (name -> password) everybody logs in: the
    plant's own clients with `credentials`, made for this start; `boards` may write only their own telemetry
    and presence and read only their own topics; other users only read. Other machines are let in only then.
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = 1883,
        *,
        users: Mapping[str, str] | None = None,
        boards: frozenset[str] = frozenset(),
        credentials: Credentials | None = None,
    ) -> None:
        self.credentials: Credentials | None = None
        if users:
            self.credentials = credentials or Credentials(user=TRUSTED, password=secrets.token_urlsafe())
        self._host = host
        self._port = port
        self._users = dict(users or {})
        self._boards = boards
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stopping: asyncio.Event | None = None

    def start(self) -> Address:
        """Listen; the address, or StartError with one sentence."""
        access = self._access()
        listener = self._bind()
        host, port = listener.getsockname()[:2]
        ready: Future[None] = Future()
        serving = self._serve(listener, access, ready)
        self._thread = threading.Thread(target=asyncio.run, args=(serving,), name="mqtt broker", daemon=True)
        self._thread.start()
        ready.result()
        return Address(host=host, port=port)

    def stop(self) -> None:
        """Drop every client, close the port, join; idempotent."""
        if self._thread is None or self._loop is None or self._stopping is None:
            return
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stopping.set)
        self._thread.join()
        self._thread = None

    def _access(self) -> Access | None:
        if not self._users:
            if not is_loopback(self._host):
                raise StartError(
                    f"A broker on {self._host} is open to other machines: give it a user and a password."
                )
            return None
        assert self.credentials is not None
        if self.credentials.user in self._users:
            raise StartError(
                f"The broker's user {self.credentials.user!r} is the plant's own: choose another name."
            )
        empty = sorted(user for user, password in self._users.items() if not user or not password)
        if empty:
            raise StartError(
                f"The broker's users need a name and a password: see {', '.join(map(repr, empty))}."
            )
        passwords = {**self._users, self.credentials.user: self.credentials.password}
        return Access(passwords=passwords, boards=self._boards, trusted=self.credentials.user)

    def _bind(self) -> socket.socket:
        family = socket.AF_INET6 if ":" in self._host else socket.AF_INET
        try:
            return socket.create_server((self._host, self._port), family=family)
        except OSError as error:
            where = Address(host=self._host, port=self._port)
            if error.errno == errno.EADDRINUSE:
                raise StartError(f"The broker cannot listen on {where}: the port is taken.") from error
            raise StartError(f"The broker cannot listen on {where}: {error.strerror or error}.") from error

    async def _serve(self, listener: socket.socket, access: Access | None, ready: Future[None]) -> None:
        self._loop, self._stopping = asyncio.get_running_loop(), asyncio.Event()
        self._loop.set_exception_handler(note_failed_task)
        silence_libraries()
        broker = GuardedBroker(listener, access)
        await broker.start()
        ready.set_result(None)
        await self._stopping.wait()
        broker.abort_all()
        try:
            await asyncio.wait_for(broker.shutdown(), STOP_S)
        except asyncio.TimeoutError:
            log.debug("the broker's clients did not end in time; their tasks are cancelled")


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach a server on `host`."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def silence_libraries() -> None:
    """amqtt logs each client's coming and going, and tracebacks for clients that break off."""
    for name in ("amqtt", "transitions"):
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)


def note_failed_task(_loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """One client's failed task is that client's end, not the broker's."""
    log.debug("broker: %s", context.get("message"), exc_info=context.get("exception"))
