"""HTTP server in a thread of its own: uvicorn and its connections."""

from __future__ import annotations

import asyncio
import logging
import socket
import struct
import threading
from collections.abc import Callable, Collection
from functools import partial
from itertools import count
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import h11
import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from arboleda.adapters import descriptors
from arboleda.adapters.rate_limit import RateLimit
from arboleda.model.errors import StartError

from . import limits
from .access.auth import LOCAL
from .access.names import DEFAULT_PORT
from .request import READS

if TYPE_CHECKING:  # slow to load, and needed for TLS only
    from arboleda.adapters.server_tls import ServerTls


class Guest(Protocol):
    """A connection as the admission sees it."""

    number: int  # in the order they came; the clocks of event loops are too coarse for it

    @property
    def peer(self) -> str | None:
        """The address it comes from."""

    @property
    def waits(self) -> bool:
        """True while the client has to act: to ask, to send the rest of a body, or to read an answer."""

    @property
    def looks(self) -> bool:
        """True while the client waits for the answer to a request that only reads."""

    @property
    def known(self) -> bool:
        """True if the client showed a login with its last request."""


G = TypeVar("G", bound=Guest)


class Admission:
    """Counts the connections of one server: at most `most`, and of one address `per_peer`.

    Where one comes too many, the oldest that waits for its client is cut, one without login before one that
    has it; where none waits for its client, as the server is flooded, the oldest that only wants to look. The
    newcomer is not: it may be about to stop the plant, and what fills a server is old.
    """

    def __init__(self, most: int) -> None:
        self.most = most
        self.per_peer = most * 5 // 8  # twenty browsers behind one address, and room for everybody else
        self._numbers = count()

    def next_number(self) -> int:
        """The number of the next connection."""
        return next(self._numbers)

    def surplus(self, guests: Collection[G], others: int, newcomer: G) -> G | None:
        """The guest to disconnect for the newcomer, which is among `guests`; None if there is room.

        `others` is the number of connections that count but cannot be cut.
        """
        mine = [guest for guest in guests if guest.peer == newcomer.peer]
        if len(mine) > self.per_peer:
            return _oldest(mine, newcomer)
        return _oldest(guests, newcomer) if len(guests) + others > self.most else None


def _oldest(crowd: Collection[G], newcomer: G) -> G:
    waiting = [guest for guest in crowd if guest.waits and guest is not newcomer]
    strangers = [guest for guest in waiting if not guest.known]
    # Who has just come has had no time to show a login. Where it is the known ones that crowd, strangers
    # keep a quarter of the places, or newcomers would push each other out.
    those = strangers if 4 * len(strangers) >= len(crowd) else waiting
    those = those or [guest for guest in crowd if guest.looks and guest is not newcomer]
    return min(those, key=lambda guest: guest.number, default=newcomer)


REQUEST_S = 10.0  # to send the head of a request
UNREAD_S = 20.0  # a client that reads nothing of what it asked for
HEAD_BYTES = 32768
NOTHING_LINGERS = struct.pack("ii", 1, 0)


class Timer:
    """Timer that calls back once, unless it is switched off first."""

    def __init__(self, seconds: float, callback: Any) -> None:
        self._seconds = seconds
        self._callback = callback
        self._handle: asyncio.TimerHandle | None = None

    def on(self) -> None:
        if self._handle is None:
            self._handle = asyncio.get_running_loop().call_later(self._seconds, self._callback)

    def off(self) -> None:
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None


class _MustRead:
    """Mixin that cuts off a client which does not read its answers."""

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)  # type: ignore[misc]
        self._unread = Timer(UNREAD_S, lambda: cut(transport))

    def connection_lost(self, exc: Exception | None) -> None:
        self._unread.off()
        super().connection_lost(exc)  # type: ignore[misc]

    def pause_writing(self) -> None:
        super().pause_writing()  # type: ignore[misc]
        self._unread.on()

    def resume_writing(self) -> None:
        super().resume_writing()  # type: ignore[misc]
        self._unread.off()


class Socket(_MustRead, WebSocketsSansIOProtocol):
    """Websocket connection."""


class Connection(_MustRead, H11Protocol):
    """HTTP connection; `admission` chooses the one to close if there are too many."""

    def __init__(self, *args: Any, admission: Admission, **options: Any) -> None:
        super().__init__(*args, **options)
        self._admission = admission

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self.number = self._admission.next_number()
        self._request = Timer(REQUEST_S, lambda: cut(transport))
        self._request.on()
        self._make_room()

    def connection_lost(self, exc: Exception | None) -> None:
        self._request.off()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if self.conn.their_state is h11.IDLE and not self.transport.is_closing():
            self._request.on()
        else:
            self._request.off()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        head, _ = self.conn.trailing_data
        if head and self.idles and not self.transport.is_closing():
            self._request.on()  # its begin came before the last answer was whole

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        self._request.off()
        super().handle_websocket_upgrade(event)

    def shutdown(self) -> None:
        """Called when the server ends: ends an answer without an end (a stream)."""
        super().shutdown()
        if not self.idles and self.cycle.response_started:
            self.transport.abort()

    @property
    def idles(self) -> bool:
        return self.cycle is None or self.cycle.response_complete

    @property
    def peer(self) -> str | None:
        return self.client[0] if self.client else None

    @property
    def waits(self) -> bool:
        return self.idles or self.cycle.more_body or self.flow.write_paused

    @property
    def looks(self) -> bool:
        return not self.idles and not self.cycle.response_started and self.scope["method"] in READS

    @property
    def known(self) -> bool:
        login = self.scope.get("arboleda.login") if self.scope is not None else None
        return login not in (None, LOCAL)  # on its own machine a plant knows nobody, and lets everybody in

    def _make_room(self) -> None:
        guests = [other for other in self.connections if isinstance(other, Connection)]
        surplus = self._admission.surplus(guests, len(self.connections) - len(guests), self)
        if surplus is not None:
            self.connections.discard(surplus)  # at once, so that the next connection does not count it
            cut(surplus.transport)


def cut(transport: Any) -> None:
    """End a connection at once, without keeping unread data for the client."""
    transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NOTHING_LINGERS)
    transport.abort()


LOG = logging.getLogger(__name__)
START_S = 20.0
STOP_S = 5.0  # connections have 1 s to close; an application that hangs then ends with the process
SENTENCE = b"This plant speaks TLS here: its address begins with https://\n"
SPEAKS_TLS = (
    b"HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain\r\nConnection: close\r\n"
    b"Content-Length: %d\r\n\r\n%s" % (len(SENTENCE), SENTENCE)
)


class Server:
    """Serves `app` on `host`, on `usual_port` or where that is taken on another, unless a `port` is named.

    At most `connections` are open at a time, websockets and streams among them. With `tls` everybody
    speaks TLS.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        host: str = "127.0.0.1",
        port: int | None = None,
        usual_port: int = DEFAULT_PORT,
        connections: int = limits.CONNECTIONS,
        tls: ServerTls | None = None,
    ) -> None:
        self._host = host
        self._port = port
        self._usual_port = usual_port
        self._server = _Uvicorn(
            uvicorn.Config(
                app,
                http=_protocol(Admission(connections), tls),  # type: ignore[arg-type]
                ws=Socket,
                ws_max_size=limits.MESSAGE_BYTES,
                ws_per_message_deflate=False,
                h11_max_incomplete_event_size=HEAD_BYTES,
                # uvloop accepts all that wait before it tells of the first: too many files at once
                loop="asyncio",
                backlog=descriptors.AT_ONCE,
                log_config=None,
                log_level=logging.CRITICAL,
                access_log=False,
                lifespan="on",
                proxy_headers=False,
                server_header=False,
                timeout_graceful_shutdown=1,
            )
        )
        self._thread: threading.Thread | None = None

    def start(self) -> int:
        """Listen and serve; returns the port, or raises StartError."""
        listener = listen(self._host, self._port, self._usual_port)
        # In a thread that is not the main one uvicorn leaves the signals alone.
        self._thread = threading.Thread(
            target=self._server.run_until_stopped, args=(listener,), name="http", daemon=True
        )
        self._thread.start()
        self._server.ready.wait(START_S)
        if not self._server.started:
            listener.close()
            self.stop()
            raise StartError("The HTTP server could not start; details are in the log.")
        return int(listener.getsockname()[1])

    def stop(self) -> None:
        """Close every connection and join, for STOP_S at most; idempotent."""
        self._server.should_exit = True
        if self._thread is not None:
            self._thread.join(STOP_S)
            if self._thread.is_alive():
                LOG.warning("the HTTP server does not end; the plant goes on ending without it")
            self._thread = None


def _protocol(admission: Admission, tls: ServerTls | None) -> Callable[..., asyncio.BaseProtocol]:
    """The factory that makes the protocol object of each connection."""
    if tls is None:
        return partial(Connection, admission=admission)
    from arboleda.adapters.tls_layer import TlsLayer

    layered = partial(
        TlsLayer, tls.context, server="The HTTP server", seldom=RateLimit(), plain_answer=SPEAKS_TLS
    )
    return lambda **options: layered(Connection(**options, admission=admission))


class _Uvicorn(uvicorn.Server):
    """uvicorn that tells when it serves, or that it never will."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.ready = threading.Event()

    def run_until_stopped(self, listener: socket.socket) -> None:
        try:
            self.run(sockets=[listener])
        except SystemExit:  # uvicorn raises it if the application did not start
            LOG.error("the application behind HTTP did not start")
        finally:
            self.ready.set()

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets=sockets)
        self.ready.set()


def listen(host: str, port: int | None, usual_port: int = DEFAULT_PORT) -> socket.socket:
    """A listener on `port`; for None on `usual_port`, or on a free one where that is taken."""
    try:
        return _bound(host, usual_port if port is None else port)
    except OSError as error:
        if port is None:
            return listen(host, 0)
        where = f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
        raise StartError(f"The HTTP server cannot listen on {where}: {error.strerror or error}.") from error


def _bound(host: str, port: int) -> socket.socket:
    # without IPv6 it raises ValueError
    both = host == "::" and socket.has_dualstack_ipv6()
    options: dict[str, Any] = {"dualstack_ipv6": True} if both else {}
    listener = descriptors.listener(host, port, **options)
    listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listener
