"""Websockets behind the guard, with a real client."""

from __future__ import annotations

import json
from contextlib import ExitStack
from typing import Any

import pytest
from tests.patience import PATIENCE_S, until
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from arboleda.web import limits
from arboleda.web.access.auth import Role

from .conftest import Web


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


def test_who_is_turned_away_gets_a_status_and_a_sentence(open_to_all):
    assert refused(open_to_all, open_to_all.origin) == (401, "This plant wants a token or a login.")
    status, sentence = refused(open_to_all, "http://evil.example", **cookie(open_to_all, Role.OPERATOR))
    assert status == 403 and sentence.startswith("Only tools and pages")


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

    def is_free() -> bool:
        try:
            with join(local, local.origin) as page:
                return page.recv() == "operator"
        except InvalidStatus:
            return False

    until(is_free)


def test_a_message_that_is_too_long_ends_its_socket(local):
    with join(local, local.origin) as page:
        page.recv()
        page.send("a" * (limits.MESSAGE_BYTES + 1))
        with pytest.raises(ConnectionClosed) as closed:
            page.recv(timeout=PATIENCE_S)
    assert closed.value.rcvd.code == 1009
