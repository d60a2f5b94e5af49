"""The HTTP API of a running plant: FastAPI on uvicorn, in a thread of its own."""

from __future__ import annotations

import asyncio
import json
import logging
import socket
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from arboleda.core.errors import ArboledaError, PayloadError, StartError, TextError

log = logging.getLogger(__name__)

View = Callable[[], dict[str, Any]]
Find = Callable[[str], "dict[str, Any] | None"]
Submit = Callable[[str], "Future[dict[str, Any]]"]

BODY_LIMIT = 4096
ANSWER_S = 5.0
LOCAL_HOSTS = {"127.0.0.1", "localhost", "[::1]"}


class Api:
    """`GET /api/plant`, `POST /api/tasks`, `GET /api/tasks/<id>`; whatever is refused says so in `sentence`.

    `view()` is the snapshot and `find(id)` one task or None, both plain data. `submit(text)` gives a future
    of a task; a state `refused` or a TextError in it is the caller's mistake, any other ArboledaError means
    "not now". The server's thread calls all of them: they must not block.
    """

    def __init__(
        self, view: View, find: Find, submit: Submit, *, host: str = "127.0.0.1", port: int = 0
    ) -> None:
        self._host = host
        self._port = port
        config = uvicorn.Config(
            Guard(make_app(view, find, submit)),
            log_config=None,
            log_level=logging.CRITICAL,
            access_log=False,
            lifespan="off",
            ws="none",
            proxy_headers=False,
            server_header=False,
            timeout_graceful_shutdown=1,
        )
        self._server = uvicorn.Server(config)
        self._thread: threading.Thread | None = None

    def start(self) -> int:
        """Listen; the port, or StartError with one sentence."""
        try:
            listener = socket.create_server((self._host, self._port))
        except OSError as error:
            where = f"{self._host}:{self._port}"
            raise StartError(f"The HTTP API cannot listen on {where}: {error.strerror or error}.") from error
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        # In a thread that is not the main one uvicorn leaves the signals alone.
        self._thread = threading.Thread(
            target=self._server.run, kwargs={"sockets": [listener]}, name="http api", daemon=True
        )
        self._thread.start()
        return int(listener.getsockname()[1])

    def stop(self) -> None:
        """Close every connection and join; idempotent."""
        self._server.should_exit = True
        if self._thread is not None:
            self._thread.join()
            self._thread = None


def make_app(view: View, find: Find, submit: Submit) -> FastAPI:
    """The routes."""
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    app.add_exception_handler(ArboledaError, refuse)
    app.add_exception_handler(HTTPException, refuse)
    app.add_exception_handler(Exception, own_up)

    @app.get("/api/plant")
    async def plant() -> JSONResponse:
        return JSONResponse(view())

    @app.post("/api/tasks")
    async def add_task(request: Request) -> JSONResponse:
        answer = submit(task_text(await request.body()))
        try:
            task = await asyncio.wait_for(asyncio.wrap_future(answer), ANSWER_S)
        except asyncio.TimeoutError:
            raise ArboledaError(
                "The plant did not answer in time; see its tasks before sending this again."
            ) from None
        return JSONResponse(task, status_code=422 if task["state"] == "refused" else 202)

    @app.get("/api/tasks/{task_id}")
    async def task(task_id: str) -> JSONResponse:
        known = find(task_id)
        if known is None:
            raise HTTPException(404, f"The plant knows no task {task_id!a}.")
        return JSONResponse(known)

    return app


def task_text(body: bytes) -> str:
    """The text in `{"text": "..."}`; PayloadError for anything else."""
    try:
        said = json.loads(body)
        text = said["text"]
        text.encode()
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        said, text = None, ""
    if not isinstance(said, dict) or len(said) != 1 or not isinstance(text, str):
        raise PayloadError('The body must be JSON like {"text": "sis_a 0B 7"}, and nothing else.')
    return text


async def refuse(_request: Request, error: Exception) -> JSONResponse:
    """A refusal as status and sentence."""
    if isinstance(error, HTTPException):
        return JSONResponse({"sentence": error.detail}, status_code=error.status_code)
    mistaken = isinstance(error, (TextError, PayloadError))
    return JSONResponse({"sentence": str(error)}, status_code=422 if mistaken else 503)


async def own_up(request: Request, error: Exception) -> JSONResponse:
    """An error of ours: the log names it, the caller gets a sentence."""
    log.error("%s %s failed: %r", request.method, request.url.path, error)
    return JSONResponse({"sentence": "The plant could not answer: internal error."}, status_code=500)


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
