"""uvicorn in a thread of its own."""

from __future__ import annotations

import asyncio
import logging
import socket
import threading
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import uvicorn
from starlette.types import ASGIApp

from arboleda.adapters import descriptors
from arboleda.adapters.rate_limit import RateLimit
from arboleda.model.errors import StartError

from . import limits
from .admission import Admission
from .connections import HEAD_BYTES, Connection, Socket
from .names import DEFAULT_PORT

if TYPE_CHECKING:  # slow to load, and needed for TLS only
    from arboleda.adapters.server_tls import ServerTls

START_S = 20.0
STOP_S = 5.0  # connections have 1 s to close; an application that hangs then ends with the process
LOG = logging.getLogger(__name__)
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


def _protocol(admission: Admission, tls: ServerTls | None) -> Callable[..., asyncio.Protocol]:
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
