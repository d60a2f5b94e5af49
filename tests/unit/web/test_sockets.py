"""Websockets behind the guard: who may join, for how long, how many, and how fast."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest
from starlette.types import Message, Receive, Scope, Send
from tests.guarded_plant import Web
from tests.web_plant import TOKENS

from arboleda.web import limits
from arboleda.web.access.auth import LOCAL, Role
from arboleda.web.access.guard import Sockets
from arboleda.web.request import HttpError

HELLO: Message = {"type": "websocket.receive", "text": "hello"}
CONNECT: Message = {"type": "websocket.connect"}
GONE: Message = {"type": "websocket.disconnect", "code": 1000}


async def page(scope: Scope, receive: Receive, send: Send) -> None:
    """Says who is there, and repeats what it hears."""
    await receive()
    await send({"type": "websocket.accept"})
    await send({"type": "websocket.send", "text": scope["arboleda.role"].value})
    while (message := await receive())["type"] == "websocket.receive":
        await send({"type": "websocket.send", "text": message["text"]})


@pytest.fixture
def local(serve: Callable[..., Web]) -> Web:
    return serve(behind=page)


@pytest.fixture
def open_to_all(serve: Callable[..., Web]) -> Web:
    return serve(dict(TOKENS), behind=page)


def joined(
    web: Web, headers: dict[str, str], before_it_speaks: Callable[[], None] = lambda: None
) -> list[Any]:
    """What a browser that says hello gets: the status with which it is refused; or the texts that it hears,
    and the code with which its socket is closed."""
    coming, got = iter([CONNECT, HELLO, GONE]), []

    async def receive() -> Message:
        message = next(coming)
        if message is HELLO:
            before_it_speaks()
        return message

    async def send(message: Message) -> None:
        got.extend(message[key] for key in ("status", "text", "code") if key in message)

    scope: Any = {"type": "websocket", "path": "/_page/socket", "raw_path": b"", "query_string": b""}
    scope |= {"server": ("127.0.0.1", 8080), "client": ("127.0.0.1", 50000)}
    named = {"host": "127.0.0.1:8080", **headers}
    scope["headers"] = [(name.encode(), value.encode()) for name, value in named.items()]
    asyncio.run(web.app(scope, receive, send))
    return got


def cookie(web: Web, role: Role) -> dict[str, str]:
    return {"cookie": f"{web.cookie}={web.session(role)}"}


def test_the_own_page_joins_and_carries_its_role(local: Web, open_to_all: Web) -> None:
    origin = {"origin": local.origin}
    assert joined(local, origin) == ["operator", "hello"]
    assert joined(open_to_all, origin | cookie(open_to_all, Role.VIEWER)) == ["viewer", "hello"]


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "https://127.0.0.1:8080", "http://127.0.0.1", None]
)
def test_a_socket_of_another_page_or_of_none_is_refused(
    local: Web, open_to_all: Web, origin: str | None
) -> None:
    headers = {} if origin is None else {"origin": origin}
    assert joined(local, headers) == [403]
    assert joined(open_to_all, headers | cookie(open_to_all, Role.OPERATOR)) == [403]


def test_a_socket_to_another_name_is_refused(local: Web) -> None:
    evil = "evil.example:8080"  # a name that resolves to this machine
    assert joined(local, {"host": evil, "origin": f"http://{evil}"}) == [403]


@pytest.mark.parametrize("headers", [{}, {"cookie": f"{Web.cookie}=wrong"}], ids=["none", "a wrong one"])
def test_a_socket_without_login_is_refused(open_to_all: Web, headers: dict[str, str]) -> None:
    assert joined(open_to_all, {"origin": open_to_all.origin, **headers}) == [401]


def test_a_tool_joins_with_its_token_and_no_origin(open_to_all: Web) -> None:
    token = {"authorization": f"Bearer {TOKENS[Role.OPERATOR]}"}
    assert joined(open_to_all, token) == ["operator", "hello"]


def test_a_socket_ends_with_its_session(open_to_all: Web) -> None:
    session = open_to_all.session(Role.OPERATOR)
    headers = {"origin": open_to_all.origin, "cookie": f"{open_to_all.cookie}={session}"}
    assert joined(open_to_all, headers, lambda: open_to_all.door.log_out(session)) == ["operator", 1008]


def test_sockets_are_limited_in_number_and_one_that_ends_makes_room() -> None:
    async def work() -> None:
        closed = asyncio.Event()

        async def stays(scope: Scope, receive: Receive, send: Send) -> None:
            await closed.wait()

        sockets = Sockets(stays, most=1)
        first = asyncio.create_task(sockets.run({}, None, None, LOCAL))
        await asyncio.sleep(0)
        with pytest.raises(HttpError, match="No more than 1 may be open at a time; close a page"):
            await sockets.run({}, None, None, LOCAL)
        closed.set()
        await first
        await sockets.run({}, None, None, LOCAL)

    asyncio.run(work())


def test_whoever_floods_is_slowed_down_and_loses_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MESSAGE", (1e-9, 3))  # so slow that no wait here makes up for it
    heard, slept = [], []
    flood = iter([{"type": "websocket.receive", "text": str(number)} for number in range(5)])

    async def page(scope: Scope, receive: Receive, send: Send) -> None:
        heard.extend([(await receive())["text"] for _ in range(5)])

    async def receive() -> Message:
        return next(flood)

    async def sleep(seconds: float) -> None:
        slept.append(seconds)

    asyncio.run(Sockets(page, sleep).run({}, receive, None, LOCAL))
    assert heard == ["0", "1", "2", "3", "4"]
    assert [seconds > 0 for seconds in slept] == [False, False, False, True, True]
