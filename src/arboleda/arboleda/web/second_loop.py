"""Second event loop and thread for all requests but stops, so that a page in the making delays no stop."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from typing import Any, TypeVar

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .request_head import RequestHead

Result = TypeVar("Result")
Call = Callable[..., Awaitable[Result]]

END_S = 3.0  # time for an application to end, and for the tasks left in the loop
OVER: Message = {"type": "lifespan.shutdown.complete"}
LOG = logging.getLogger(__name__)


class SecondLoop:
    """Runs `app` in a second event loop; a stop it runs in the loop of the server.

    A page or a snapshot of a large plant takes a tenth of a second. In the server's loop nothing is made that
    takes so long: it takes in, checks who asks, stops, and passes bytes on. The end of the server waits
    END_S at most for what runs in the second loop.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._second = _SecondLoop()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            return await self._live(scope, receive, send)
        if RequestHead(scope).stops:
            return await self._app(scope, receive, send)
        return await self._run_there(scope, receive, send)

    async def _live(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the second loop for as long as the application lives."""
        ending = asyncio.Event()

        async def receive_noted() -> Message:
            message = await receive()
            if message["type"] == "lifespan.shutdown":
                ending.set()
            return message

        async def send_others(message: Message) -> None:
            if message["type"] != OVER["type"]:
                await send(message)

        self._second.start()
        life = asyncio.create_task(self._run_there(scope, receive_noted, send_others))
        asked_to_end = asyncio.create_task(ending.wait())
        await asyncio.wait({life, asked_to_end}, return_when=asyncio.FIRST_COMPLETED)
        await asyncio.wait({life}, timeout=END_S)
        await self._second.end()
        asked_to_end.cancel()
        if life.done() and not life.cancelled():
            life.result()
        await send(OVER)

    async def _run_there(self, scope: Scope, receive: Receive, send: Send) -> None:
        here = asyncio.get_running_loop()

        async def receive_here() -> Message:
            return await _in(here, receive)

        async def send_here(message: Message) -> None:
            await _in(here, send, message)

        await _in(self._second.loop, self._app, scope, receive_here, send_here)


class _SecondLoop:
    """An event loop in a daemon thread, from `start` to `end`."""

    def __init__(self) -> None:
        self._running: Future[asyncio.AbstractEventLoop] = Future()
        self._over = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="http pages", daemon=True)

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        return self._running.result()

    def start(self) -> None:
        self._thread.start()
        self._running.result()

    async def end(self) -> None:
        """Cancel the tasks that still run there, and wait for END_S at most."""
        self.loop.call_soon_threadsafe(self._over.set)
        await asyncio.to_thread(self._thread.join, END_S)
        if self._thread.is_alive():
            LOG.warning("what the web server made for its pages did not end within %g s; it is left", END_S)

    def _run(self) -> None:
        asyncio.run(self._until_over())

    async def _until_over(self) -> None:
        self._running.set_result(asyncio.get_running_loop())
        await self._over.wait()


async def _in(loop: asyncio.AbstractEventLoop, call: Call[Result], *args: Any) -> Result:
    """The result of `call` in that loop; cancelling this cancels it there."""
    if loop.is_closed():  # the server has ended, and nobody waits for this any more
        raise asyncio.CancelledError
    return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(_awaited(call, *args), loop))


async def _awaited(call: Call[Result], *args: Any) -> Result:
    return await call(*args)
