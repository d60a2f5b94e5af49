"""Bytes that are no request, or half of one: the real server refuses them, and they reach no plant."""

from __future__ import annotations

import socket

import httpx
import pytest
from tests.patience import PATIENCE_S
from tests.web_plant import VIEW, Plant

from .conftest import Web


def raw(port: int, request: bytes) -> bytes:
    """What the server says to these bytes, until it closes."""
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as talk:
        talk.sendall(request)
        said = b""
        while chunk := talk.recv(65536):
            said += chunk
        return said


@pytest.mark.parametrize(
    ("target", "more", "status"),
    [
        ("/api/plant/release", ["Host: evil.example"], b"400"),
        ("http://evil.example/api/plant/release", [], b"403"),
    ],
    ids=["two hosts", "another place"],
)
def test_a_request_with_two_meanings_does_nothing(
    local: Web, plant: Plant, target: str, more: list[str], status: bytes
) -> None:
    lines = [f"POST {target} HTTP/1.1", f"Host: 127.0.0.1:{local.port}", *more, "Connection: close", "", ""]
    assert raw(local.port, "\r\n".join(lines).encode()).split()[1] == status
    assert plant.acts == []


def test_garbage_is_answered_and_closed(local: Web, web: httpx.Client) -> None:
    assert raw(local.port, b"\x16\x03\x01\x02\x00" + b"\x00" * 600 + b"\r\n\r\n").startswith(b"HTTP/1.1 400 ")
    assert web.get("/api/plant").status_code == 200


def test_headers_without_end_are_cut_off(local: Web) -> None:
    with socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as talk:
        talk.sendall(b"GET / HTTP/1.1\r\nX-A: " + b"a" * 40_000)
        assert talk.recv(100).startswith(b"HTTP/1.1 400 ")


RELEASE = "POST /api/plant/release HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n"


def test_a_body_without_end_is_refused_while_it_comes(local: Web, plant: Plant) -> None:
    head = RELEASE.format(port=local.port)
    with socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as talk:
        chunks = (b"400\r\n" + b"a" * 1024 + b"\r\n") * 5
        talk.sendall(f"{head}Transfer-Encoding: chunked\r\n\r\n".encode() + chunks)
        assert talk.recv(100).startswith(b"HTTP/1.1 413 ")
    assert plant.acts == []


def test_a_body_that_breaks_off_does_nothing(local: Web, web: httpx.Client, plant: Plant) -> None:
    head = RELEASE.format(port=local.port)
    with socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as talk:
        talk.sendall(f"{head}Content-Length: 9\r\n\r\n".encode())
    assert web.get("/api/plant").json() == VIEW
    assert plant.acts == []
