"""Websocket as a stream of lines: each message that comes is one, each line that is written is a message."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from websockets.client import ClientProtocol
from websockets.exceptions import WebSocketException
from websockets.frames import Frame, Opcode
from websockets.protocol import State
from websockets.uri import parse_uri

from .stream_driver import TcpStream


class WebSocketStream(TcpStream):
    """Websocket at a host; it is read by one thread, and written by any."""

    def __init__(self, host: str, port: int, path: str, headers: Mapping[str, str]) -> None:
        super().__init__(host, port)
        self._lock = threading.Lock()  # around the protocol, and the order of what it sends
        self._part = b""
        name = f"[{host}]" if ":" in host else host
        self._protocol = ClientProtocol(parse_uri(f"ws://{name}:{port}{path}"))
        request = self._protocol.connect()
        request.headers.update(headers)
        try:
            self._protocol.send_request(request)
            self._flush()
            self._shake_hands()
        except BaseException:  # whatever ends it, the socket is closed; the exception goes on
            self.close()
            raise

    def _shake_hands(self) -> None:
        """Wait for the other end's answer, byte by byte.

        What comes right behind it stays in the socket: a selector would not see what was read here.
        """
        while self._protocol.state is State.CONNECTING:
            data = self._socket.recv(1)
            if not data:
                raise OSError("it has closed the connection before it was a websocket")
            self._protocol.receive_data(data)
            if self._protocol.handshake_exc is not None:
                raise OSError(f"it opens no websocket: {self._protocol.handshake_exc}")

    def read(self) -> bytes:
        """The lines that came; an empty one for what is no message, nothing at the end."""
        data = super().read()
        with self._lock:
            if data:
                self._protocol.receive_data(data)
                self._flush()  # such as the answer to a ping
            lines = b"".join(map(self._line, self._protocol.events_received()))
            is_open = data and self._protocol.state is State.OPEN
        return lines or (b"\n" if is_open else b"")

    def _line(self, event: object) -> bytes:
        if not isinstance(event, Frame) or event.opcode not in (Opcode.TEXT, Opcode.BINARY, Opcode.CONT):
            return b""
        self._part += event.data
        if not event.fin:
            return b""
        whole, self._part = self._part, b""
        return whole.replace(b"\n", b" ") + b"\n"

    def write(self, data: bytes) -> None:
        with self._lock:
            try:
                for line in data.splitlines():
                    self._protocol.send_text(line)
            except WebSocketException as error:
                raise OSError(str(error)) from error
            self._flush()

    def _flush(self) -> None:
        for data in self._protocol.data_to_send():
            if data:
                super().write(data)
