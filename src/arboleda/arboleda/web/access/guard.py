"""Guard of the HTTP server: access control, limits of bodies and websockets, one long answer at a time."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from itertools import count
from urllib.parse import parse_qsl

from starlette.responses import RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from arboleda.client.protocol import PLANT
from arboleda.model.outside import quoted

from .. import limits
from ..limits import Buckets
from ..request import LOGIN, ClientGone, HttpError, RequestHead, with_headers
from .auth import LOCAL, Door, Login
from .names import Names
from .takes import Takes


async def whole_body(head: RequestHead, receive: Receive, declared: int = 0) -> Receive:
    """A `receive` with the whole body; HttpError if it is too long or slow, ClientGone if it ends early. It
    may have the usual number of bytes, or what its route has `declared` if that is more."""
    most = max(declared, limits.PAGE_BODY_BYTES if head.for_page else limits.API_BODY_BYTES)
    try:
        body = await asyncio.wait_for(_read(receive, most), limits.BODY_S)
    except asyncio.TimeoutError:
        raise HttpError(408, f"The body did not come within {limits.BODY_S:.0f} s.") from None
    waiting: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def next_message() -> Message:
        return waiting.pop() if waiting else await receive()

    return next_message


async def _read(receive: Receive, most: int) -> bytes:
    body, more = b"", True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            raise ClientGone
        body += message.get("body", b"")
        more = message.get("more_body", False)
        if len(body) > most:
            raise HttpError(413, f"The body may have {most} bytes.")
    return body


class SerialRequests:
    """Runner of `app` that works on one request at a time.

    Sending an answer does not count as work: a client that reads slowly keeps nobody waiting.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._free = asyncio.Lock()

    async def run(self, scope: Scope, receive: Receive, send: Send, hears: Receive) -> None:
        """Run one request after those before it; nothing if `hears` shows that its client has left."""
        await self._free.acquire()
        working = True

        async def send_freed(message: Message) -> None:
            nonlocal working
            if working:
                working = False
                self._free.release()
            await send(message)

        try:
            if not await _gone(hears):
                await self._app(scope, receive, send_freed)
        finally:
            if working:
                self._free.release()


async def _gone(hears: Receive) -> bool:
    """True if the client has disconnected; after the body nothing else can come from it."""
    coming = asyncio.ensure_future(hears())
    await asyncio.sleep(0)
    if coming.done():
        return bool(coming.result()["type"] == "http.disconnect")
    coming.cancel()
    return False


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


IN_URL = {"token", "access_token", "bearer", "authorization"}
NOT_OURS = "Only tools and pages of this plant may use this address."
GUESSED = "Too many wrong tokens; wait a minute."


class Guard:
    """Lets in whom `door` and `names` know, within the limits; all else gets a sentence.

    What is let in carries `scope["arboleda.login"]`, `["arboleda.role"]` and `["arboleda.door"]`. A stop of
    somebody who is logged in has no rate. At most so many `sockets` are open at a time. `plant` is the name
    of the plant that answers, "" where there are several. `takes` tells of a request what its route takes
    beyond the usual.
    """

    def __init__(
        self,
        app: ASGIApp,
        names: Names,
        door: Door,
        *,
        sockets: int = limits.SOCKETS,
        plant: str = "",
        takes: Callable[[Scope], Takes | None] = lambda _: None,
    ) -> None:
        self._app = app
        self._takes = takes
        self._plant = plant
        self._names = names
        self._door = door
        self._pages = SerialRequests(app)
        self._sockets = Sockets(app, most=sockets)
        self._reads, self._changes = Buckets(limits.READ), Buckets(limits.CHANGE)
        self._files, self._opens = Buckets(limits.PAGE), Buckets(limits.OPEN)
        self._guesses, self._holds = Buckets(limits.GUESS), Buckets(limits.HOLD)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            return await self._app(scope, receive, send)
        send = with_headers(scope, send)
        try:
            return await self._serve(RequestHead(scope), receive, send)
        except HttpError as turned:
            return await turned.answer(scope, receive, send)
        except ClientGone:
            return None

    async def _serve(self, head: RequestHead, receive: Receive, send: Send) -> None:
        self._check_shape(head)
        self._check_names(head)
        peer = head.peer(proxied=self._names.public is not None)
        login = self._login(head, peer)
        self._check_origin(head, login)
        more = None if head.socket or head.reads else self._takes(head.scope)
        if login is None or not head.stops:
            rate = self._holds if more is not None and more.held else self._rate(head)
            self._check_rate(rate, peer if login in (None, LOCAL) else login.key)
        if login is None and not head.logs_in:
            raise _unknown(head)
        self._check_plant(head)
        scope = self._introduced(head.scope, login)
        if head.socket:
            assert login is not None  # nobody logs in by a socket
            return await self._sockets.run(scope, receive, send, login)
        if head.logs_in:
            send = self._counting_guesses(peer, send)
        body = await whole_body(head, receive, 0 if more is None else more.body_bytes)
        if head.opens_page:
            return await self._pages.run(scope, body, send, receive)
        return await self._app(scope, body, send)

    def _check_shape(self, head: RequestHead) -> None:
        if head.header_bytes > limits.HEADER_BYTES:
            raise HttpError(431, f"Address and headers may have {limits.HEADER_BYTES} bytes.")
        if head.ambiguous:
            raise HttpError(400, "A header that counts once is there twice, or the body has two lengths.")
        query = parse_qsl(head.scope["query_string"].decode("latin-1"), keep_blank_values=True)
        if any(name.lower() in IN_URL for name, _ in query):
            raise HttpError(400, "A token does not belong into an address: it stays in logs and histories.")

    def _check_names(self, head: RequestHead) -> None:
        host = head.header("host")
        if not self._names.knows_host(host):
            raise HttpError(
                403, f"This plant is not called {quoted(host, 80)}; --public-url gives it a name."
            )
        if self._door.open and head.forwarded:
            raise HttpError(403, "A proxy asks, and this plant is for its own machine; see --public-url.")

    def _check_plant(self, head: RequestHead) -> None:
        meant = head.header(PLANT)
        if meant and self._plant and meant != self._plant:
            raise HttpError(421, f"This is the plant {self._plant}, and {quoted(meant, 80)} is meant.")

    def _check_origin(self, head: RequestHead, login: Login | None) -> None:
        if head.has("origin"):
            if not self._names.knows_origin(head.header("origin"), head.header("host")):
                raise HttpError(403, NOT_OURS)
            return
        if head.from_elsewhere:
            raise HttpError(403, NOT_OURS)
        if login is None and not head.logs_in:
            return  # refused in any case, as a token is missing
        by_token = head.bearer is not None and login is not None
        if not (head.reads or by_token or (self._door.open and head.for_api)):
            raise HttpError(
                403, "The browser must name the page this comes from (Origin); tools send a token."
            )

    def _login(self, head: RequestHead, peer: str) -> Login | None:
        """The login of a request, None if it has none; raises HttpError for a wrong token."""
        if self._door.open:
            return LOCAL
        if head.bearer is not None:
            # A right token passes whoever else guesses from that address: it may be about to stop something.
            return self._door.by_token(head.bearer) or self._guessed(peer)
        if head.logs_in and not head.reads and self._guesses.empty(peer):
            raise HttpError(429, GUESSED, retry_after="60")
        return self._door.by_cookie(head.session) if head.session is not None else None

    def _guessed(self, peer: str) -> Login | None:
        if not self._guesses.take(peer):
            raise HttpError(429, GUESSED, retry_after="60")
        raise HttpError(401, "This token is not valid.", www_authenticate="Bearer")

    def _counting_guesses(self, peer: str, send: Send) -> Send:
        async def counting(message: Message) -> None:
            if message["type"] == "http.response.start" and message["status"] == 401:
                self._guesses.take(peer)
            await send(message)

        return counting

    def _check_rate(self, rate: Buckets, key: str) -> None:
        if not rate.take(key):
            raise HttpError(429, "Too many requests; wait a second.", retry_after="1")

    def _rate(self, head: RequestHead) -> Buckets:
        if not head.reads:
            return self._changes
        if head.opens_page:
            return self._opens
        return self._files if head.for_page else self._reads

    def _introduced(self, scope: Scope, login: Login | None) -> Scope:
        """The scope with who it is; what a proxy says of its paths is not passed on. The server's own scope
        has the login as well: its connection is then that of somebody known."""
        scope["arboleda.login"] = login
        kept = [pair for pair in scope["headers"] if not pair[0].startswith(b"x-forwarded-")]
        role = login.role if login else None
        known = {"arboleda.login": login, "arboleda.role": role, "arboleda.door": self._door}
        return {**scope, "headers": kept, **known}


def _unknown(head: RequestHead) -> HttpError:
    turned = HttpError(401, "This plant wants a token or a login.", www_authenticate="Bearer")
    if head.wants_page:
        turned.answer = RedirectResponse(head.at(LOGIN) if head.opens_page else LOGIN, status_code=303)
    return turned
