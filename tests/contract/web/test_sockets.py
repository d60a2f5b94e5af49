"""Websockets behind the guard, with a real client."""

from __future__ import annotations

import asyncio
import json
import socket
from contextlib import ExitStack
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from arboleda.web import limits
from arboleda.web.access.auth import LOCAL, Role
from arboleda.web.access.guard import Sockets

from ...patience import PATIENCE_S
from .conftest import TOKENS, Web


def join(web: Web, origin: str | None = None, **headers: str) -> ClientConnection:
    where = f"ws://127.0.0.1:{web.port}/_page/socket"
    options: dict[str, Any] = {"additional_headers": headers, "compression": None, "proxy": None}
    return connect(where, origin=origin, **options)


def refused(web: Web, origin: str | None = None, **headers: str) -> tuple[int, str]:
    """The status and sentence with which a socket is turned away."""
    with pytest.raises(InvalidStatus) as turned, join(web, origin, **headers):
        pass
    answer = turned.value.response
    return answer.status_code, json.loads(answer.body)["sentence"]


def cookie(web: Web, role: Role) -> dict[str, str]:
    return {"cookie": f"{web.cookie}={web.session(role)}"}


def test_the_own_page_joins_and_carries_its_role(local, open_to_all):
    with join(local, local.origin) as page:
        assert page.recv() == "operator"
    with join(open_to_all, open_to_all.origin, **cookie(open_to_all, Role.VIEWER)) as page:
        assert page.recv() == "viewer"
        page.send("hello")
        assert page.recv() == "hello"


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1", "http://localhost", None],
)
def test_a_socket_of_another_page_or_of_none_is_refused(local, open_to_all, origin):
    assert refused(local, origin)[0] == 403
    status, sentence = refused(open_to_all, origin, **cookie(open_to_all, Role.OPERATOR))
    assert status == 403 and sentence.startswith(("Only tools and pages", "The browser must name"))


def test_a_socket_to_another_name_is_refused(local):
    evil = f"ws://evil.example:{local.port}/_page/socket"  # a name that resolves to this machine
    with (
        socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as way,
        pytest.raises(InvalidStatus) as turned,
    ):
        connect(evil, sock=way, origin=f"http://evil.example:{local.port}", proxy=None)
    assert turned.value.response.status_code == 403


def test_a_socket_without_login_is_refused(open_to_all):
    assert refused(open_to_all, open_to_all.origin) == (401, "This plant wants a token or a login.")
    wrong = {"cookie": f"{open_to_all.cookie}=wrong"}
    assert refused(open_to_all, open_to_all.origin, **wrong)[0] == 401


def test_a_tool_joins_with_its_token_and_no_origin(open_to_all):
    with join(open_to_all, authorization=f"Bearer {TOKENS[Role.OPERATOR]}") as tool:
        assert tool.recv() == "operator"


def test_a_socket_ends_with_its_session(open_to_all):
    session = open_to_all.session(Role.OPERATOR)
    with join(open_to_all, open_to_all.origin, cookie=f"{open_to_all.cookie}={session}") as page:
        assert page.recv() == "operator"
        open_to_all.door.log_out(session)
        page.send("still there?")
        with pytest.raises(ConnectionClosed) as closed:
            page.recv(timeout=PATIENCE_S)
    assert (closed.value.rcvd.code, closed.value.rcvd.reason) == (1008, "logged out")


def test_sockets_are_limited_in_number_and_the_api_still_answers(serve):
    local = serve(sockets=3)
    with ExitStack() as open_pages:
        pages = [open_pages.enter_context(join(local, local.origin)) for _ in range(3)]
        assert [page.recv() for page in pages] == ["operator"] * 3
        assert refused(local, local.origin) == (503, "No more than 3 may be open at a time; close a page.")
        assert local.client().post("/api/plant/stop").status_code == 200
    with join(local, local.origin) as page:
        assert page.recv() == "operator"


def test_a_message_that_is_too_long_ends_its_socket(local):
    with join(local, local.origin) as page:
        page.recv()
        page.send("a" * (limits.MESSAGE_BYTES + 1))
        with pytest.raises(ConnectionClosed) as closed:
            page.recv(timeout=PATIENCE_S)
    assert closed.value.rcvd.code == 1009


def test_whoever_floods_is_slowed_down_and_loses_nothing(monkeypatch):
    monkeypatch.setattr(limits, "MESSAGE", (0.05, 200))  # so slow that no wait here makes up for it
    heard, slept = [], []
    flood = iter([{"type": "websocket.receive", "text": str(number)} for number in range(250)])

    async def page(scope, receive, send):
        heard.extend([(await receive())["text"] for _ in range(250)])

    async def receive():
        return next(flood)

    async def sleep(seconds: float) -> None:
        slept.append(seconds)

    asyncio.run(Sockets(page, sleep).run({}, receive, None, LOCAL))
    assert heard == [str(number) for number in range(250)]
    assert set(slept[: limits.MESSAGE[1]]) == {0.0} and 900 < slept[-1] <= 1000
