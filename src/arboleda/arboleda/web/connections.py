"""Connections of the HTTP server: a limited number, and none that waits for ever."""

from __future__ import annotations

import asyncio
import socket
import struct
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from .admission import Admission
from .auth import LOCAL
from .request_head import READS

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
