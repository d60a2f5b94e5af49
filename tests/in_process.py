"""ASGI applications that are asked in this process: without a socket, without a thread."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from typing import Any

import anyio
import httpx
import pytest
from starlette.types import ASGIApp

ORIGIN = "http://127.0.0.1:8080"
PEER = ("127.0.0.1", 50000)


def without_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have what an application gives to a pool of threads done where it is given."""

    async def done(work: Callable[..., Any], *args: Any, **_: Any) -> Any:
        return work(*args)

    monkeypatch.setattr(anyio.to_thread, "run_sync", done)
    monkeypatch.setattr(asyncio, "to_thread", done)


class Caller:
    """Somebody who asks an application, with headers and cookies that stay from one request to the next."""

    def __init__(
        self, app: ASGIApp, at: str = ORIGIN, *, cookies: Mapping[str, str] | None = None, **headers: str
    ) -> None:
        transport = httpx.ASGITransport(app, raise_app_exceptions=False, client=PEER)
        self._http = httpx.AsyncClient(transport=transport, base_url=at, headers=headers, cookies=cookies)
        self.headers, self.cookies = self._http.headers, self._http.cookies

    def request(self, method: str, path: str, **options: Any) -> httpx.Response:
        return asyncio.run(self._http.request(method, path, **options))

    def get(self, path: str, **options: Any) -> httpx.Response:
        return self.request("GET", path, **options)

    def post(self, path: str, **options: Any) -> httpx.Response:
        return self.request("POST", path, **options)


class Machine(httpx.BaseTransport, httpx.AsyncBaseTransport):
    """The ports of this machine, as clients reach them that are made from now on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.asked: list[int] = []
        self._listening: dict[int, list[ASGIApp | Exception]] = {}
        for name in ("Client", "AsyncClient"):
            self._replace(monkeypatch, name)

    def listen(self, port: int, *those: ASGIApp | Exception) -> None:
        """Have applications listen at a port, each for one request and the last from then on; or have clients
        get errors. Where nobody listens, no connection comes about."""
        self._listening[port] = list(those)

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        return asyncio.run(self.handle_async_request(request))

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        port = request.url.port or 80
        self.asked.append(port)
        waiting = self._listening.get(port, [httpx.ConnectError("nobody listens")])
        there = waiting.pop(0) if len(waiting) > 1 else waiting[0]
        if isinstance(there, Exception):
            raise type(there)(*there.args)  # another one each time, as each gets a context of its own
        transport = httpx.ASGITransport(there, raise_app_exceptions=False, client=PEER)
        answer = await transport.handle_async_request(request)
        return httpx.Response(answer.status_code, headers=answer.headers, content=await answer.aread())

    def _replace(self, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
        usual = getattr(httpx, name)
        monkeypatch.setattr(httpx, name, lambda **options: usual(**options, transport=self))


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    """The ports of this machine, for clients that sleep no time and applications without threads."""
    without_threads(monkeypatch)
    monkeypatch.setattr(time, "sleep", lambda seconds: None)
    return Machine(monkeypatch)
