"""Apart: an event loop of its own for all that is not a stop, so that no page in the making delays one."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine
from typing import Any, TypeVar

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .asked import Asked

Result = TypeVar("Result")


class Apart:
    """Runs `app` in a loop and a thread of their own; a stop it runs in the loop of the server.

    A page or a snapshot of a large plant takes a tenth of a second. In the server's loop nothing is made that
    takes so long: it only takes in, checks who asks, stops, and passes bytes on.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._loop: asyncio.AbstractEventLoop | None = None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            return await self._live(scope, receive, send)
        if Asked(scope).stops:
            return await self._app(scope, receive, send)
        return await self._run_there(scope, receive, send)

    async def _live(self, scope: Scope, receive: Receive, send: Send) -> None:
        """The thread is there for as long as the application lives."""
        self._loop = asyncio.new_event_loop()
        thread = threading.Thread(target=_serve, args=(self._loop,), name="http pages", daemon=True)
        thread.start()
        try:
            await self._run_there(scope, receive, send)
        finally:
            self._loop.call_soon_threadsafe(self._loop.stop)

    async def _run_there(self, scope: Scope, receive: Receive, send: Send) -> None:
        there, here = self._loop, asyncio.get_running_loop()
        assert there is not None, "the lifespan of an application begins before its first request"

        async def receive_here() -> Message:
            return await _in(here, receive())

        async def send_here(message: Message) -> None:
            await _in(here, _sent(send, message))

        await _in(there, _answered(self._app, scope, receive_here, send_here))


async def _sent(send: Send, message: Message) -> None:
    await send(message)


async def _answered(app: ASGIApp, scope: Scope, receive: Receive, send: Send) -> None:
    await app(scope, receive, send)


async def _in(loop: asyncio.AbstractEventLoop, work: Coroutine[Any, Any, Result]) -> Result:
    """What `work` comes to in that loop; cancelled here, it is cancelled there."""
    return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, loop))


def _serve(loop: asyncio.AbstractEventLoop) -> None:
    """In the thread: until the loop is stopped; then what still runs in it is cancelled."""
    asyncio.set_event_loop(loop)
    try:
        loop.run_forever()
        _end(loop)
    finally:
        loop.close()


def _end(loop: asyncio.AbstractEventLoop) -> None:
    left = asyncio.all_tasks(loop)
    for task in left:
        task.cancel()
    loop.run_until_complete(asyncio.gather(*left, return_exceptions=True))
    loop.run_until_complete(loop.shutdown_asyncgens())
    loop.run_until_complete(loop.shutdown_default_executor())
