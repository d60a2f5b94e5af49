"""Websockets: a limited number, each slowed to a rate, and ended with the login under it."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from itertools import count

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from . import limits
from .auth import Login
from .http_errors import HttpError
from .limits import Buckets

LOGGED_OUT: Message = {"type": "websocket.close", "code": 1008, "reason": "logged out"}


class Sockets:
    """Runs websockets of `app`."""

    def __init__(
        self,
        app: ASGIApp,
        sleep: Callable[[float], Awaitable[None]] = asyncio.sleep,
        *,
        most: int = limits.SOCKETS,
    ) -> None:
        self._app = app
        self._most = most
        self._sleep = sleep
        self._rates = Buckets(limits.MESSAGE)
        self._names = count()
        self._open = 0

    async def run(self, scope: Scope, receive: Receive, send: Send, login: Login) -> None:
        """Run one websocket until its end; raises HttpError if too many are open."""
        if self._open >= self._most:
            many = f"No more than {self._most} may be open at a time; close a page."
            raise HttpError(503, many, retry_after=limits.LATER_S)
        one = _Socket(receive, send, login, self._pace())
        self._open += 1
        try:
            await self._app(scope, one.receive, one.send)
        finally:
            self._open -= 1

    def _pace(self) -> Callable[[], Awaitable[None]]:
        name = str(next(self._names))
        return lambda: self._sleep(self._rates.delay_s(name))


class _Socket:
    def __init__(
        self, receive: Receive, send: Send, login: Login, pace: Callable[[], Awaitable[None]]
    ) -> None:
        self._receive = receive
        self._send = send
        self._login = login
        self._pace = pace
        self._over = False

    async def receive(self) -> Message:
        """The next message, no faster than the rate: whoever floods waits, and nothing is lost."""
        message = await self._receive()
        if message["type"] != "websocket.receive":
            return message
        await self._pace()
        return message if await self._known() else {"type": "websocket.disconnect", "code": 1008}

    async def send(self, message: Message) -> None:
        if message["type"] != "websocket.send" or await self._known():
            self._over = self._over or message["type"] == "websocket.close"
            await self._send(message)

    async def _known(self) -> bool:
        """True if the login is still valid; closes the socket if not."""
        if not self._over and not self._login.alive():
            await self.send(LOGGED_OUT)
        return not self._over
