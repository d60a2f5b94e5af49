"""Access control and rate limits of the server: pure ASGI, for HTTP and websockets alike."""

from __future__ import annotations

from urllib.parse import parse_qsl

from starlette.responses import RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from arboleda.model.outside import quoted

from . import limits
from .auth import LOCAL, Door, Login
from .body import whole_body
from .headers import with_headers
from .http_errors import ClientGone, HttpError
from .limits import Buckets
from .names import Names
from .request_head import LOGIN, PLANT, RequestHead
from .serial_requests import SerialRequests
from .sockets import Sockets

IN_URL = {"token", "access_token", "bearer", "authorization"}
NOT_OURS = "Only tools and pages of this plant may use this address."
GUESSED = "Too many wrong tokens; wait a minute."


class Guard:
    """Lets in whom `door` and `names` know, within the limits; all else gets a sentence.

    What is let in carries `scope["arboleda.login"]`, `["arboleda.role"]` and `["arboleda.door"]`. A stop of
    somebody who is logged in has no rate. At most so many `sockets` are open at a time. `plant` is the name
    of the plant that answers, "" where there are several.
    """

    def __init__(
        self, app: ASGIApp, names: Names, door: Door, *, sockets: int = limits.SOCKETS, plant: str = ""
    ) -> None:
        self._app = app
        self._plant = plant
        self._names = names
        self._door = door
        self._pages = SerialRequests(app)
        self._sockets = Sockets(app, most=sockets)
        self._reads, self._changes = Buckets(limits.READ), Buckets(limits.CHANGE)
        self._files, self._opens = Buckets(limits.PAGE), Buckets(limits.OPEN)
        self._guesses = Buckets(limits.GUESS)

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

    async def _serve(self, asked: RequestHead, receive: Receive, send: Send) -> None:
        self._check_shape(asked)
        self._check_names(asked)
        peer = asked.peer(proxied=self._names.public is not None)
        login = self._login(asked, peer)
        self._check_origin(asked, login)
        if login is None or not asked.stops:
            self._check_rate(asked, peer if login in (None, LOCAL) else login.key)
        if login is None and not asked.logs_in:
            raise _unknown(asked)
        self._check_plant(asked)
        scope = self._introduced(asked.scope, login)
        if asked.socket:
            return await self._sockets.run(scope, receive, send, login)
        if asked.logs_in:
            send = self._counting_guesses(peer, send)
        body = await whole_body(asked, receive)
        if asked.opens_page:
            return await self._pages.run(scope, body, send, receive)
        return await self._app(scope, body, send)

    def _check_shape(self, asked: RequestHead) -> None:
        if asked.header_bytes > limits.HEADER_BYTES:
            raise HttpError(431, f"Address and headers may have {limits.HEADER_BYTES} bytes.")
        if asked.ambiguous:
            raise HttpError(400, "A header that counts once is there twice, or the body has two lengths.")
        query = parse_qsl(asked.scope["query_string"].decode("latin-1"), keep_blank_values=True)
        if any(name.lower() in IN_URL for name, _ in query):
            raise HttpError(400, "A token does not belong into an address: it stays in logs and histories.")

    def _check_names(self, asked: RequestHead) -> None:
        host = asked.header("host")
        if not self._names.knows_host(host):
            raise HttpError(
                403, f"This plant is not called {quoted(host, 80)}; --public-url gives it a name."
            )
        if self._door.open and asked.forwarded:
            raise HttpError(403, "A proxy asks, and this plant is for its own machine; see --public-url.")

    def _check_plant(self, asked: RequestHead) -> None:
        meant = asked.header(PLANT)
        if meant and self._plant and meant != self._plant:
            raise HttpError(421, f"This is the plant {self._plant}, and {quoted(meant, 80)} is meant.")

    def _check_origin(self, asked: RequestHead, login: Login | None) -> None:
        if asked.has("origin"):
            if not self._names.knows_origin(asked.header("origin"), asked.header("host")):
                raise HttpError(403, NOT_OURS)
            return
        if asked.from_elsewhere:
            raise HttpError(403, NOT_OURS)
        if login is None and not asked.logs_in:
            return  # refused in any case, as a token is missing
        by_token = asked.bearer is not None and login is not None
        if not (asked.reads or by_token or (self._door.open and asked.for_api)):
            raise HttpError(
                403, "The browser must name the page this comes from (Origin); tools send a token."
            )

    def _login(self, asked: RequestHead, peer: str) -> Login | None:
        """The login of a request, None if it has none; raises HttpError for a wrong token."""
        if self._door.open:
            return LOCAL
        if asked.bearer is not None:
            # A right token passes whoever else guesses from that address: it may be about to stop something.
            return self._door.by_token(asked.bearer) or self._guessed(peer)
        if asked.logs_in and not asked.reads and self._guesses.empty(peer):
            raise HttpError(429, GUESSED, retry_after="60")
        return self._door.by_cookie(asked.session) if asked.session is not None else None

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

    def _check_rate(self, asked: RequestHead, key: str) -> None:
        if not self._rate(asked).take(key):
            raise HttpError(429, "Too many requests; wait a second.", retry_after="1")

    def _rate(self, asked: RequestHead) -> Buckets:
        if not asked.reads:
            return self._changes
        if asked.opens_page:
            return self._opens
        return self._files if asked.for_page else self._reads

    def _introduced(self, scope: Scope, login: Login | None) -> Scope:
        """The scope with who it is; what a proxy says of its paths is not passed on. The server's own scope
        has the login as well: its connection is then that of somebody known."""
        scope["arboleda.login"] = login
        kept = [pair for pair in scope["headers"] if not pair[0].startswith(b"x-forwarded-")]
        role = login.role if login else None
        known = {"arboleda.login": login, "arboleda.role": role, "arboleda.door": self._door}
        return {**scope, "headers": kept, **known}


def _unknown(asked: RequestHead) -> HttpError:
    turned = HttpError(401, "This plant wants a token or a login.", www_authenticate="Bearer")
    if asked.wants_page:
        turned.answer = RedirectResponse(asked.at(LOGIN) if asked.opens_page else LOGIN, status_code=303)
    return turned
