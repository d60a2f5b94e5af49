"""A websocket as a stream of lines, at the line of a virtual device and at servers that are none."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator

import pytest
from websockets.sync.server import ServerConnection, serve

from arboleda.adapters.web_socket import WebSocketStream
from arboleda.virtual.web_socket_line import WebSocketLine

from ..patience import PATIENCE_S

pytestmark = pytest.mark.system

HOST = "127.0.0.1"


class Echo:
    """Machine at the far end that says every line again."""

    next_deadline = 0.05

    def __init__(self) -> None:
        self.is_unplugged = False

    def step(self, now: float, data: bytes = b"") -> bytes:
        self.next_deadline = now + 0.05
        return data


@pytest.fixture
def line() -> Iterator[WebSocketLine]:
    line = WebSocketLine(Echo())
    line.start()
    yield line
    line.stop()


def connected(port: int) -> WebSocketStream:
    return WebSocketStream(HOST, port, "/websocket", {})


def heard(stream: WebSocketStream, size: int) -> bytes:
    """What came, without empty lines, once there are so many bytes."""
    data, end = b"", time.monotonic() + PATIENCE_S
    while len(data) < size and time.monotonic() < end:
        got = stream.read()
        assert got
        data += got.lstrip(b"\n")
    return data


def test_every_line_is_a_message_and_comes_back_as_one(line: WebSocketLine) -> None:
    stream = connected(line.port)
    stream.write(b"one\ntwo\n")
    assert heard(stream, 8) == b"one\ntwo\n"
    stream.close()


def test_the_last_client_has_the_line(line: WebSocketLine) -> None:
    first, second = connected(line.port), connected(line.port)
    second.write(b"second\n")
    assert heard(second, 7) == b"second\n"
    assert first.read() == b""
    first.close()
    second.close()


def test_an_unplugged_one_lets_nobody_in(line: WebSocketLine) -> None:
    stream = connected(line.port)
    assert isinstance(line.machine, Echo)
    line.machine.is_unplugged = True
    assert stream.read() == b""
    stream.close()
    with pytest.raises(OSError, match=r"closed the connection|reset"):
        connected(line.port)


def test_a_message_in_parts_is_one_line_and_a_ping_is_none() -> None:
    keys: list[str | None] = []

    def talk(connection: ServerConnection) -> None:
        assert connection.request is not None
        keys.append(connection.request.headers.get("X-Api-Key"))
        connection.send(["one ", "line\n", " still"])
        assert connection.ping().wait(PATIENCE_S)
        connection.send("end")

    with serve(talk, HOST, 0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        port = server.socket.getsockname()[1]
        stream = WebSocketStream(HOST, port, "/websocket", {"X-Api-Key": "k"})
        assert heard(stream, 19) == b"one line  still\nend\n"
        assert keys == ["k"]
        while stream.read():
            pass
        stream.close()
        server.shutdown()
        thread.join()


def test_a_server_that_is_no_websocket_is_named() -> None:
    with socket.create_server((HOST, 0)) as server:

        def answer() -> None:
            client, _ = server.accept()
            client.recv(4096)
            client.sendall(b"HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n")
            client.close()

        thread = threading.Thread(target=answer)
        thread.start()
        with pytest.raises(OSError, match=r"it opens no websocket: .*401"):
            connected(server.getsockname()[1])
        thread.join()
