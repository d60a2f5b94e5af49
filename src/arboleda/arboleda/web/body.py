"""Body of a request, read as a whole before anybody acts on it."""

from __future__ import annotations

import asyncio

from starlette.types import Message, Receive

from . import limits
from .http_errors import ClientGone, HttpError
from .request_head import RequestHead


async def whole_body(asked: RequestHead, receive: Receive) -> Receive:
    """A `receive` with the whole body; HttpError if it is too long or slow, ClientGone if it ends early."""
    most = limits.PAGE_BODY_BYTES if asked.for_page else limits.API_BODY_BYTES
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
