"""A websocket as a stream of lines, at the line of a virtual device and at servers that are none."""

from __future__ import annotations

import selectors
import socket
import threading
import time
from collections.abc import Iterator

import pytest
from tests.patience import PATIENCE_S
from websockets.http11 import Request
from websockets.server import ServerProtocol
from websockets.sync.server import ServerConnection, serve

from arboleda_drivers.connections import stream_driver as stream
from arboleda_drivers.connections.web_socket import WebSocketStream
from arboleda_drivers.virtual.web_socket_line import WebSocketLine

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


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """An end that answers late on a busy machine is waited for."""
    monkeypatch.setattr(stream, "CONNECT_S", PATIENCE_S)


@pytest.fixture
def line() -> Iterator[WebSocketLine]:
    line = WebSocketLine(Echo())
    line.start()
    yield line
    line.stop()


def connected(port: int) -> WebSocketStream:
    return WebSocketStream(HOST, port, "/websocket", {})


def heard(there: WebSocketStream, size: int) -> bytes:
    """Data that came, without empty lines, once there are so many bytes."""
    data, end = b"", time.monotonic() + PATIENCE_S
    while len(data) < size and time.monotonic() < end:
        got = there.read()
        assert got
        data += got.lstrip(b"\n")
    return data


def test_every_line_is_a_message_and_the_last_client_has_the_line(line: WebSocketLine) -> None:
    first = connected(line.port)
    first.write(b"one\ntwo\n")
    assert heard(first, 8) == b"one\ntwo\n"
    second = connected(line.port)
    second.write(b"second\n")
    assert heard(second, 7) == b"second\n"
    while first.read():  # an empty line may be on its way
        pass
    first.close()
    second.close()


def test_a_line_that_is_unplugged_ends_its_client_and_lets_nobody_in(line: WebSocketLine) -> None:
    client = connected(line.port)
    assert isinstance(line.machine, Echo)
    line.machine.is_unplugged = True
    while client.read():
        pass
    client.close()
    with pytest.raises(OSError, match=r"closed the connection|reset"):
        connected(line.port)


def test_a_message_right_behind_the_answer_is_seen_by_a_selector() -> None:
    clients: list[socket.socket] = []

    with socket.create_server((HOST, 0)) as server:

        def answer() -> None:
            client, _ = server.accept()
            clients.append(client)
            protocol = ServerProtocol()
            while not (requests := protocol.events_received()):
                protocol.receive_data(client.recv(4096))
            assert isinstance(requests[0], Request)
            protocol.send_response(protocol.accept(requests[0]))
            protocol.send_text(b"first")
            client.sendall(b"".join(protocol.data_to_send()))  # both at once

        thread = threading.Thread(target=answer)
        thread.start()
        there = connected(server.getsockname()[1])
        thread.join()
        with selectors.DefaultSelector() as selector:
            selector.register(there, selectors.EVENT_READ)
            assert selector.select(PATIENCE_S)
        assert there.read() == b"first\n"
        there.close()
        clients[0].close()


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
        there = WebSocketStream(HOST, port, "/websocket", {"X-Api-Key": "k"})
        assert heard(there, 19) == b"one line  still\nend\n"
        assert keys == ["k"]
        while there.read():
            pass
        there.close()
        server.shutdown()
        thread.join()


def test_a_server_that_is_no_websocket_is_named() -> None:
    with socket.create_server((HOST, 0)) as no_websocket:

        def answer() -> None:
            client, _ = no_websocket.accept()
            with client, client.makefile("rb") as asked:
                while asked.readline().strip():  # all of it: what is left unread resets the connection
                    pass
                client.sendall(b"HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n")

        thread = threading.Thread(target=answer)
        thread.start()
        with pytest.raises(OSError, match=r"it opens no websocket: .*401"):
            connected(no_websocket.getsockname()[1])
        thread.join()
