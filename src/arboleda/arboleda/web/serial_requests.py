"""Answers that take long to make are made one by one: between two of them everybody else gets a turn."""

from __future__ import annotations

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send


class SerialRequests:
    """Runs requests of `app` so that only one is being worked on. Sending an answer is no work: a client
    that reads slowly keeps nobody waiting."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._free = asyncio.Lock()

    async def run(self, scope: Scope, receive: Receive, send: Send, hears: Receive) -> None:
        """One request, once those before it are made; nothing where its client is gone by then, as the
        server's own receive, `hears`, says."""
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
    """Whether the client has left; nothing else can come from it, as its body is read."""
    coming = asyncio.ensure_future(hears())
    await asyncio.sleep(0)
    if coming.done():
        return bool(coming.result()["type"] == "http.disconnect")
    coming.cancel()
    return False
