"""The page of a plant that runs, made once the plant is heard: its libraries take a fifth of a start."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, InvalidStateError
from contextlib import asynccontextmanager, suppress
from typing import Any

from fastapi import FastAPI

from arboleda.host.pieces import Pieces
from arboleda.web.api import answer_in_sentences

from .page_api import WAITING, PageApi, Seen

LATEST_S = (
    5.0  # by then it is made though a robot is silent: later it would take its time from robots at work
)
LOG = logging.getLogger(__name__)


class LatePage:
    """LatePage: ASGI application that is made once every robot is heard, at the first request for it, or
    after LATEST_S.

    Who asks before it is there waits for it. It shows what the plant did meanwhile. `made` is called once it
    is there, in a thread.
    """

    def __init__(self, plant: PageApi, pieces: Pieces | None, made: Callable[[], None]) -> None:
        self._plant = plant
        self._pieces = pieces
        self._made = made
        self._seen: deque[Seen] = deque(maxlen=WAITING)
        self._wanted = Future[None]()
        self._page = Future[FastAPI]()
        self._unwatch = plant.watch(self._saw)

    def mount(self, server: FastAPI) -> None:
        """Serve the page for all that this app has no route for."""
        server.mount("/", self)
        server.router.lifespan_context = self._lifespan

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        self._want()
        page = await asyncio.shield(asyncio.wrap_future(self._page))
        await page(scope, receive, send)

    def _saw(self, snapshot: dict[str, Any]) -> None:
        """Take in a snapshot, in the plant's thread."""
        self._seen.append((time.time(), snapshot))
        if all(robot["online"] for robot in snapshot["robots"]):
            self._want()

    def _want(self) -> None:
        with suppress(InvalidStateError):
            self._wanted.set_result(None)

    @asynccontextmanager
    async def _lifespan(self, _server: FastAPI) -> AsyncIterator[None]:
        over = asyncio.Event()
        life = asyncio.create_task(self._live(over))
        yield
        over.set()
        self._wanted.cancel()
        await asyncio.wait([life])

    async def _live(self, over: asyncio.Event) -> None:
        with suppress(asyncio.TimeoutError):
            await asyncio.wait_for(asyncio.wrap_future(self._wanted), LATEST_S)
        try:
            page = await asyncio.to_thread(self._make)
            async with page.router.lifespan_context(page):
                self._unwatch()
                self._page.set_result(page)
                await over.wait()
        except Exception as error:
            LOG.exception("the page cannot be shown")
            if not self._page.done():
                self._page.set_exception(error)

    def _make(self) -> FastAPI:
        from . import page

        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None, redirect_slashes=False)
        answer_in_sentences(app)
        page.mount(app, self._plant, self._pieces, lambda: [*self._seen])
        self._made()
        return app
