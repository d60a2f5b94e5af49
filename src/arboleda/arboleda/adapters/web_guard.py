"""Who may use the HTTP API: this machine's own tools and pages, in small bodies."""

from __future__ import annotations

from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

BODY_LIMIT = 4096
LOCAL_HOSTS = {"127.0.0.1", "localhost", "[::1]"}


class Guard:
    """Lets in what this machine's own tools and pages send, in small bodies; all else gets a sentence.

    A page of another site may make the browser send requests here, under its own name (Origin) or,
    with a name that suddenly resolves to this machine, under ours (Host).
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        host, origin = headers.get("host", ""), headers.get("origin")
        if host_name(host) not in LOCAL_HOSTS or origin not in (None, f"http://{host}"):
            return await self._answer(
                403, "Only tools and pages of this machine may use this API.", scope, receive, send
            )
        body = await read_body(receive)
        if body is None:
            return await self._answer(413, f"The body may have {BODY_LIMIT} bytes.", scope, receive, send)
        return await self._app(scope, replayed(body, receive), send)

    @staticmethod
    async def _answer(status: int, sentence: str, scope: Scope, receive: Receive, send: Send) -> None:
        answer = JSONResponse({"sentence": sentence}, status_code=status, headers={"connection": "close"})
        await answer(scope, receive, send)


def host_name(host: str) -> str:
    """A Host header without its port."""
    name, _, port = host.rpartition(":")
    return name.lower() if name and port.isdigit() else host.lower()


async def read_body(receive: Receive) -> bytes | None:
    """The whole body; None as soon as it is too long."""
    body, more = b"", True
    while more:
        message = await receive()
        body += message.get("body", b"")
        more = message.get("more_body", False)
        if len(body) > BODY_LIMIT:
            return None
    return body


def replayed(body: bytes, receive: Receive) -> Receive:
    """A `receive` that hands out the body first."""
    waiting: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def next_message() -> Message:
        return waiting.pop() if waiting else await receive()

    return next_message
