"""The second event loop of the HTTP server, in which all but stops is made, and which waits for stops.

Each package has a loop of its own for its routes, with threads of its own.
"""

from __future__ import annotations

import asyncio
import logging
import threading
import time
from collections.abc import Awaitable, Callable, Collection, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from contextvars import Context
from typing import Any, TypeVar

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .package_routes import APART
from .request import RequestHead

Result = TypeVar("Result")
Call = Callable[..., Awaitable[Result]]

END_S = 3.0  # time for an application to end, and for the tasks left in the loop
OVER: Message = {"type": "lifespan.shutdown.complete"}
LOG = logging.getLogger(__name__)


PAUSE_S = 0.2  # for a stop, at most: pages go on, however long its answer takes


class StopsUnderWay:
    """Stops whose answers are under way; whatever else is made `gives_way` meanwhile."""

    def __init__(self) -> None:
        self._count = 0
        self._pause_ends = 0.0
        self._none = threading.Event()
        self._none.set()

    @contextmanager
    def one(self) -> Iterator[None]:
        """Context in which a stop is answered; in the server's loop."""
        if not self._count:
            self._pause_ends = time.monotonic() + PAUSE_S
            self._none.clear()
        self._count += 1
        try:
            yield
        finally:
            self._count -= 1
            if not self._count:
                self._none.set()

    def give_way(self) -> None:
        """Return once no stop is under way, or the first of them has been for PAUSE_S."""
        if not self._none.is_set():
            self._none.wait(max(0.0, self._pause_ends - time.monotonic()))


class GivingWay(asyncio.SelectorEventLoop):
    """Event loop that begins no step of a task while a stop is under way.

    A step keeps the interpreter's lock busy for some milliseconds, and a stop needs that lock in several
    threads, one after the other.
    """

    def __init__(self, stops: StopsUnderWay) -> None:
        super().__init__()
        self._stops = stops

    def call_soon(  # type: ignore[override]  # Python 3.10 has no TypeVarTuple
        self, callback: Any, *args: Any, context: Context | None = None
    ) -> asyncio.Handle:
        return super().call_soon(self._in_turn, callback, *args, context=context)

    def _in_turn(self, callback: Any, *args: Any) -> None:
        self._stops.give_way()
        callback(*args)


class SecondLoop:
    """Runs `app` in a second event loop, which gives way to stops; those it runs in the loop of the server.

    A page or a snapshot of a large plant takes a tenth of a second. In the server's loop nothing is made that
    takes so long: it takes in, checks who asks, stops, and passes bytes on. A route of a package that sleeps
    or hangs delays no route but those of its package. The end of the server waits END_S at most for what runs
    in other loops.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._stops = StopsUnderWay()
        self._second = _LoopThread(self._stops, "http pages")
        self._packages: dict[str, _LoopThread] = {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            return await self._live(scope, receive, send)
        if RequestHead(scope).stops:
            with self._stops.one():
                return await self._app(scope, receive, send)
        return await self._run_there({**scope, APART: self._run_apart}, receive, send)

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
        end_request = asyncio.create_task(ending.wait())
        await asyncio.wait({life, end_request}, return_when=asyncio.FIRST_COMPLETED)
        await asyncio.wait({life}, timeout=END_S)
        await asyncio.gather(*(each.end() for each in (self._second, *self._packages.values())))
        end_request.cancel()
        if life.done() and not life.cancelled():
            life.result()
        await send(OVER)

    async def _run_there(self, scope: Scope, receive: Receive, send: Send) -> None:
        await _run_in(self._second.loop, self._app, scope, receive, send)

    async def _run_apart(
        self, package: str, app: ASGIApp, scope: Scope, receive: Receive, send: Send
    ) -> None:
        """Run an application in the loop of a package; called in the second loop."""
        if package not in self._packages:
            self._packages[package] = _LoopThread(self._stops, f"routes of {package}")
            self._packages[package].start()
        await _run_in(self._packages[package].loop, app, scope, receive, send)


class _LoopThread:
    """An event loop in a daemon thread, from `start` to `end`."""

    def __init__(self, stops: StopsUnderWay, name: str) -> None:
        self._stops = stops
        self._running: Future[asyncio.AbstractEventLoop] = Future()
        self._over = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

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
            LOG.warning(
                "the web server leaves its %s, which did not end within %g s", self._thread.name, END_S
            )

    def _run(self) -> None:
        loop = GivingWay(self._stops)
        asyncio.set_event_loop(loop)
        try:
            loop.run_until_complete(self._until_over())
            loop.run_until_complete(_cancelled(asyncio.all_tasks(loop)))
            loop.run_until_complete(loop.shutdown_asyncgens())
            loop.run_until_complete(loop.shutdown_default_executor())
        finally:
            asyncio.set_event_loop(None)
            loop.close()

    async def _until_over(self) -> None:
        self._running.set_result(asyncio.get_running_loop())
        await self._over.wait()


async def _cancelled(tasks: Collection[asyncio.Task[Any]]) -> None:
    """Cancel tasks and wait for their end."""
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def _run_in(
    loop: asyncio.AbstractEventLoop, app: ASGIApp, scope: Scope, receive: Receive, send: Send
) -> None:
    """Run an application in that loop; what it receives and sends goes through the present one."""
    here = asyncio.get_running_loop()

    async def receive_here() -> Message:
        return await _in(here, receive)

    async def send_here(message: Message) -> None:
        await _in(here, send, message)

    await _in(loop, app, scope, receive_here, send_here)


async def _in(loop: asyncio.AbstractEventLoop, call: Call[Result], *args: Any) -> Result:
    """The result of `call` in that loop; cancelling this cancels it there."""
    if loop.is_closed():  # the server has ended, and nobody waits for this any more
        raise asyncio.CancelledError
    return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(_awaited(call, *args), loop))


async def _awaited(call: Call[Result], *args: Any) -> Result:
    return await call(*args)
