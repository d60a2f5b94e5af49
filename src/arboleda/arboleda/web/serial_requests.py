"""Queue for answers that take long to make: one is made at a time, and others get a turn in between."""

from __future__ import annotations

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send


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
