"""Connections that somebody opens and leaves alone, and where the server listens."""

from __future__ import annotations

import http.client
import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial

import pytest
import uvicorn
from tests.patience import PATIENCE_S
from tests.web_plant import VIEW

from arboleda.model.errors import StartError
from arboleda.web import server
from arboleda.web.server import Server

from .conftest import Web


@contextmanager
def idle(web: Web, count: int, said: bytes = b"") -> Iterator[list[socket.socket]]:
    with ExitStack() as stack:
        talks = []
        for _ in range(count):
            talks.append(
                stack.enter_context(socket.create_connection(("127.0.0.1", web.port), timeout=PATIENCE_S))
            )
            talks[-1].sendall(said)
        yield talks


def ended(talk: socket.socket) -> bool:
    """Whether the server closed it, within the socket's timeout."""
    try:
        return talk.recv(1) == b""
    except ConnectionResetError:
        return True


@pytest.fixture
def kept(serve: Callable[..., Web], monkeypatch: pytest.MonkeyPatch) -> Web:
    """A server that ends idle connections later than a test waits."""
    patient = partial(uvicorn.Config, timeout_keep_alive=int(4 * PATIENCE_S))
    monkeypatch.setattr(server.uvicorn, "Config", patient)
    return serve()


@contextmanager
def answered(web: Web, said: bytes) -> Iterator[socket.socket]:
    """A connection whose first request has come through, which a busy machine can be too slow for."""
    while True:
        with idle(web, 1, said) as (talk,):
            if talk.recv(65536).startswith(b"HTTP/1.1 200 "):
                yield talk
                return


def test_a_request_that_does_not_come_is_waited_for_only_so_long(local, monkeypatch):
    monkeypatch.setattr(server, "REQUEST_S", 0.1)
    with idle(local, 1) as (silent,), idle(local, 1, b"GET / HTTP/1.1\r\nX-A: ") as (half,):
        assert ended(silent) and ended(half)


def test_a_second_request_that_does_not_come_is_not_waited_for_either(kept, monkeypatch):
    monkeypatch.setattr(server, "REQUEST_S", 0.1)
    asked = f"GET /api/plant HTTP/1.1\r\nHost: 127.0.0.1:{kept.port}\r\n\r\n".encode()
    with answered(kept, asked) as talk:
        talk.sendall(b"GET /")
        while not ended(talk):
            pass


def test_a_second_request_that_begins_with_the_first_is_not_waited_for_either(kept, monkeypatch):
    monkeypatch.setattr(server, "REQUEST_S", 0.1)
    asked = f"GET /api/plant HTTP/1.1\r\nHost: 127.0.0.1:{kept.port}\r\n\r\nGET /".encode()
    with answered(kept, asked) as talk:
        while not ended(talk):
            pass


def test_idle_connections_of_one_client_make_room_for_one_that_asks(serve):
    local = serve(connections=13)  # five eighths of them are for one client
    with idle(local, 20) as talks:
        assert local.client().post("/api/plant/stop").status_code == 200
        assert all(ended(talk) for talk in talks[:12])
        talks[-1].sendall(f"GET /api/plant HTTP/1.1\r\nHost: 127.0.0.1:{local.port}\r\n\r\n".encode())
        assert talks[-1].recv(100).startswith(b"HTTP/1.1 200 ")


def test_a_port_that_was_named_is_refused_where_it_is_taken(local, serve):
    with pytest.raises(StartError, match=f"cannot listen on 127.0.0.1:{local.port}: "):
        serve(port=local.port)


def test_another_port_is_found_where_the_usual_one_is_taken(local, serve):
    other = serve(port=None, usual_port=local.port)
    assert other.port != local.port
    assert other.client().get("/api/plant").json() == VIEW


def test_an_application_that_does_not_start_is_one_sentence():
    async def broken(scope, receive, send):
        raise RuntimeError("no")

    with pytest.raises(StartError, match="could not start"):
        Server(broken, port=0).start()


def test_it_stops_once_and_for_all_though_a_connection_is_open(serve, monkeypatch):
    monkeypatch.setattr(server, "STOP_S", PATIENCE_S)
    web = serve()
    kept = http.client.HTTPConnection("127.0.0.1", web.port, timeout=PATIENCE_S)
    kept.request("GET", "/api/plant")
    assert json.load(kept.getresponse()) == VIEW
    web.server.stop()
    web.server.stop()
    kept.close()
    assert "http" not in {thread.name for thread in threading.enumerate()}
