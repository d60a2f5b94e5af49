"""The broker that comes with the plant, in a thread of its own."""

from __future__ import annotations

import asyncio
import errno
import ipaddress
import logging
import secrets
import socket
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING, Any

from arboleda.model.errors import StartError

from . import descriptors
from .broker_login import Address, Credentials
from .mqtt_broker.access import Access
from .mqtt_broker.client import Client
from .mqtt_broker.packets import Answer, connack
from .mqtt_broker.router import Router
from .mqtt_broker.sessions import Sessions
from .rate_limit import RateLimit

if TYPE_CHECKING:  # slow to load, and needed for TLS only
    import ssl

    from .server_tls import ServerTls

log = logging.getLogger(__name__)

PLANT = "arboleda"
CHECK_S = 5.0
RECEIVE_BUFFER_BYTES = 64 * 1024  # in the kernel, of each connection
STRANGERS = {  # logins to try: CONNECT of MQTT 3.1.1, a clean session, keep-alive 5 s
    "nobody in particular": b"\x10\x0d\x00\x04MQTT\x04\x02\x00\x05\x00\x01x",
    "a user without password": b"\x10\x17\x00\x04MQTT\x04\x82\x00\x05\x00\x01x\x00\x08arboleda",
    "a wrong password": b"\x10\x1a\x00\x04MQTT\x04\xc2\x00\x05\x00\x01x\x00\x08arboleda\x00\x01x",
}


class EmbeddedBroker:
    """An MQTT 3.1.1 broker on `host:port` (0: any free port).

    Without `users` anybody on this machine may use it. With users (name -> password) everybody logs in;
    `boards` may write only their own telemetry and presence and read only their own topics; other users only
    read. Other machines are let in only then. The plant's own clients log in with `credentials`, made for
    this start: the limits for others are not for them. With `tls` everybody speaks TLS, and where that asks
    for certificates, users show one with their name. `connections` is how many may be open at once, for None
    its share of the files that this process may open.
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = 1883,
        *,
        users: Mapping[str, str] | None = None,
        boards: frozenset[str] = frozenset(),
        credentials: Credentials | None = None,
        connections: int | None = None,
        tls: ServerTls | None = None,
    ) -> None:
        self.credentials = credentials or Credentials(user=PLANT, password=secrets.token_urlsafe())
        self._host = host
        self._port = port
        self._users = dict(users or {})
        self._boards = boards
        self._tls = tls
        self._connections = connections or descriptors.shares(len(boards)).mqtt
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stopping: asyncio.Event | None = None

    def start(self) -> Address:
        """Listen, and with users see that strangers are turned away; the address, or StartError."""
        access = self._access()
        listener = self._bind()
        host, port = listener.getsockname()[:2]
        ready: Future[None] = Future()
        serving = self._serve(listener, access, ready)
        self._thread = threading.Thread(target=asyncio.run, args=(serving,), name="mqtt broker", daemon=True)
        self._thread.start()
        ready.result()
        try:
            if not access.guests:
                refuse_strangers(listener, self._believing)
        except BaseException:  # after any error the open broker is closed
            self.stop()
            raise
        return Address(host=host, port=port, tls=self._believing)

    def stop(self) -> None:
        """Drop every client, close the port, join; idempotent."""
        if self._thread is None or self._loop is None or self._stopping is None:
            return
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stopping.set)
        self._thread.join()
        self._thread = None

    @property
    def _believing(self) -> ssl.SSLContext | None:
        """The TLS settings by which the plant's own clients trust this broker; None without TLS."""
        from .server_tls import pinned

        return pinned(self._tls.pem) if self._tls is not None else None

    def _access(self) -> Access:
        if not self._users and not is_loopback(self._host):
            raise StartError(
                f"A broker on {self._host} is open to other machines: give it a user and a password."
            )
        if self.credentials.user in self._users:
            raise StartError(
                f"The broker's user {self.credentials.user!r} is the plant's own: choose another name."
            )
        empty = sorted(user for user, password in self._users.items() if not user or not password)
        if empty:
            raise StartError(
                f"The broker's users need a name and a password: see {', '.join(map(repr, empty))}."
            )
        return Access(
            plant=(self.credentials.user, self.credentials.password),
            passwords=self._users,
            boards=self._boards,
            guests=not self._users,
            certified=self._tls is not None and self._tls.asks,
        )

    def _bind(self) -> socket.socket:
        try:
            listener = descriptors.listener(self._host, self._port)
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
            return listener
        except OSError as error:
            where = Address(host=self._host, port=self._port)
            if error.errno == errno.EADDRINUSE:
                raise StartError(f"The broker cannot listen on {where}: the port is taken.") from error
            raise StartError(f"The broker cannot listen on {where}: {error.strerror or error}.") from error

    def _protocols(self, sessions: Sessions, router: Router) -> Callable[[], asyncio.BaseProtocol]:
        """The factory that makes the protocol object of each connection."""
        if self._tls is None:
            return lambda: Client(sessions, router)
        from .tls_layer import TlsLayer

        layered = partial(TlsLayer, self._tls.context, server="The plant's own broker", seldom=RateLimit())
        return lambda: layered(Client(sessions, router))

    async def _serve(self, listener: socket.socket, access: Access, ready: Future[None]) -> None:
        self._loop, self._stopping = asyncio.get_running_loop(), asyncio.Event()
        self._loop.set_exception_handler(note_failure)
        sessions, router = Sessions(access, self._connections), Router(access)
        server = await self._loop.create_server(
            self._protocols(sessions, router), sock=listener, backlog=descriptors.AT_ONCE
        )
        ready.set_result(None)
        await self._stopping.wait()
        server.close()
        sessions.end()
        await asyncio.sleep(0)  # the connections learn that they are closed


def refuse_strangers(listener: socket.socket, tls: ssl.SSLContext | None = None) -> None:
    """Check that the broker refuses a login without a user, without a password, and with a wrong one.

    Raises StartError if one of them is let in, or if nobody answers.
    """
    host, port = listener.getsockname()[:2]
    with ExitStack() as opened:
        talks = {}
        for who, hello in STRANGERS.items():
            talk = opened.enter_context(socket.create_connection((host, port), CHECK_S))
            talks[who] = opened.enter_context(tls.wrap_socket(talk)) if tls is not None else talk
            talks[who].sendall(hello)
        for who, talk in talks.items():
            try:
                with talk.makefile("rb") as stream:
                    answer = stream.read(4)
            except OSError as error:
                raise StartError(f"The broker does not answer its own check: {error}.") from error
            if answer != connack(Answer.NOT_AUTHORIZED):
                raise StartError(f"The broker lets in {who}: it is not opened, and this is a bug to report.")


def note_failure(_loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Log a failure that one client's data caused; it ends that client, not the broker."""
    log.error("the broker: %s", context.get("message"), exc_info=context.get("exception"))


def is_loopback(host: str) -> bool:
    """True if a server on `host` can be reached from this machine only."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
