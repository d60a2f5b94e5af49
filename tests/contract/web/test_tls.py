"""The server with TLS: requests, sockets, logins, the commands; and what is not TLS."""

from __future__ import annotations

import asyncio
import logging
import socket
import ssl
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.patience import PATIENCE_S
from tests.tls_lab import Lab
from tests.web_plant import TOKENS, VIEW
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from arboleda.adapters.server_tls import ServerTls, server_tls
from arboleda.cli.client import PlantClient
from arboleda.model.errors import ArboledaError
from arboleda.runtime.state import StateDir
from arboleda.web import server
from arboleda.web.access.auth import Role

from .conftest import Web


@pytest.fixture
def tls(lab: Lab) -> ServerTls:
    return server_tls(*lab.sign("127.0.0.1"))


@pytest.fixture
def secure(serve: Callable[..., Web], tls: ServerTls) -> Web:
    return serve(dict(TOKENS), tls=tls)


def test_who_believes_the_authority_is_answered_by_both_versions_that_are_still_safe(
    serve: Callable[..., Web], tls: ServerTls, lab: Lab
) -> None:
    web = serve(tls=tls)
    for version in (ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3):
        believing = ssl.create_default_context(cafile=lab.certificate)
        believing.minimum_version = believing.maximum_version = version
        with httpx.Client(verify=believing, trust_env=False, timeout=PATIENCE_S) as client:
            assert client.get(f"{web.origin}/api/plant").json() == VIEW, version


def test_who_does_not_believe_it_is_told_of(secure: Web, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, logger="arboleda.web")
    with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
        httpx.get(secure.origin, trust_env=False, timeout=PATIENCE_S)
    end = time.monotonic() + PATIENCE_S
    while "HTTP server: a client at 127.0.0.1 does not believe this certificate" not in caplog.text:
        assert time.monotonic() < end
        time.sleep(0.01)


def test_the_login_of_a_browser_is_for_encrypted_connections_only(secure: Web) -> None:
    browser = secure.client(origin=secure.origin)
    answer = browser.post("/login", data={"token": TOKENS[Role.OPERATOR]})
    words = {word.strip().lower() for word in answer.headers["set-cookie"].split(";")}
    assert answer.status_code == 303 and {"secure", "httponly", "samesite=strict"} <= words
    assert browser.post("/api/plant/reset").status_code == 200


async def talk(web: Web, origin: str, headers: dict[str, str], *says: str) -> list[str | bytes]:
    """What the page's socket hears first, and after each of these.

    Not by the client with threads: two of them use its one end of TLS at once, and now and then it hangs.
    """
    where = f"wss://127.0.0.1:{web.port}/_page/socket"
    options: dict[str, Any] = {"additional_headers": headers, "compression": None, "proxy": None}
    async with connect(where, origin=origin, ssl=web.believing, **options) as page:
        heard = [await page.recv()]
        for each in says:
            await page.send(each)
            heard.append(await page.recv())
        return heard


def test_the_pages_socket_speaks_both_ways(secure: Web) -> None:
    session = {"cookie": f"{secure.cookie}={secure.session(Role.VIEWER)}"}
    long = "x" * 60_000  # several records of TLS
    assert asyncio.run(talk(secure, secure.origin, session, "hello", long)) == ["viewer", "hello", long]


def test_a_page_of_the_same_origin_in_clear_gets_no_socket(secure: Web) -> None:
    session = {"cookie": f"{secure.cookie}={secure.session(Role.VIEWER)}"}
    with pytest.raises(InvalidStatus, match="403"):
        asyncio.run(talk(secure, secure.origin.replace("https", "http"), session))


def test_who_asks_in_clear_is_told_how_to_ask(secure: Web) -> None:
    answer = httpx.get(f"http://127.0.0.1:{secure.port}/api/plant", trust_env=False, timeout=PATIENCE_S)
    assert (answer.status_code, answer.text) == (
        400,
        "This plant speaks TLS here: its address begins with https://\n",
    )


def test_tls_to_a_port_without_it_breaks_no_more_than_that(local: Web) -> None:
    with pytest.raises(httpx.HTTPError):
        httpx.get(local.origin.replace("http", "https"), trust_env=False, timeout=PATIENCE_S)
    assert local.client().get("/api/plant").status_code == 200


def test_the_commands_believe_the_certificate_that_the_state_directory_has(
    serve: Callable[..., Web], lab: Lab, tmp_path: Path
) -> None:
    tls = server_tls(*lab.sign("mill.lab", days=-1))  # neither its name nor its age count here
    web = serve(tls=tls)
    with StateDir(tmp_path) as made:
        made.announce(web.port, certificate=tls.pem)
        assert PlantClient(tmp_path).status() == VIEW
        assert next(PlantClient(tmp_path).changes())[0] == "snapshot"
        made.announce(web.port, certificate=server_tls(*lab.sign("127.0.0.1")).pem)
        with pytest.raises(ArboledaError, match="did not answer"):
            PlantClient(tmp_path).status()


def test_who_connects_and_begins_no_handshake_is_cut_off(
    secure: Web, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "REQUEST_S", 0.2)
    silent = socket.create_connection(("127.0.0.1", secure.port), PATIENCE_S)
    with silent, pytest.raises(ConnectionResetError):
        silent.recv(1)


def test_a_newcomer_is_let_in_where_others_begin_no_handshake(
    serve: Callable[..., Web], tls: ServerTls
) -> None:
    web = serve(tls=tls, connections=8)
    with ExitStack() as stack:
        for _ in range(12):
            stack.enter_context(socket.create_connection(("127.0.0.1", web.port), PATIENCE_S))
        assert web.client().post("/api/plant/stop").status_code == 200


def test_it_ends_while_a_stream_is_open(
    serve: Callable[..., Web], tls: ServerTls, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "STOP_S", PATIENCE_S)
    web = serve(tls=tls)
    with web.client().stream("GET", "/api/events") as answer:
        next(answer.iter_lines())
        web.server.stop()
        assert "http" not in {thread.name for thread in threading.enumerate()}
