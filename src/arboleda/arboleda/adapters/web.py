"""The HTTP API of a running plant: FastAPI on uvicorn, in a thread of its own."""

from __future__ import annotations

import asyncio
import json
import logging
import socket
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Protocol, TypeVar

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from arboleda.core.errors import ArboledaError, PayloadError, StartError, TextError
from arboleda.core.messages import OperatorAnswer, Verb

from .web_guard import Guard

log = logging.getLogger(__name__)

View = Callable[[], dict[str, Any]]
Find = Callable[[str], "dict[str, Any] | None"]
Submit = Callable[[str], "Future[dict[str, Any]]"]
Answer = TypeVar("Answer")

ANSWER_S = 5.0


class Operate(Protocol):
    """Ask for an operator's act; `scope` is "" for the whole plant."""

    def __call__(self, verb: Verb, scope: str, *, by_hand: bool) -> Future[OperatorAnswer]: ...


class Api:
    """The snapshot, tasks and the operators' verbs; whatever is refused says so in `sentence`.

    `view()` is the snapshot and `find(id)` one task or None, both plain data. `submit(text)` gives a future
    of a task; a state `refused` or a TextError in it is the caller's mistake, any other ArboledaError means
    "not now". The server's thread calls all of them: they must not block.
    """

    def __init__(
        self,
        view: View,
        find: Find,
        submit: Submit,
        operate: Operate,
        *,
        host: str = "127.0.0.1",
        port: int = 0,
    ) -> None:
        self._host = host
        self._port = port
        config = uvicorn.Config(
            Guard(make_app(view, find, submit, operate)),
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


def make_app(view: View, find: Find, submit: Submit, operate: Operate) -> FastAPI:
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
        task = await in_time(submit(task_text(await request.body())))
        return JSONResponse(task, status_code=422 if task["state"] == "refused" else 202)

    @app.get("/api/tasks/{task_id}")
    async def task(task_id: str) -> JSONResponse:
        known = find(task_id)
        if known is None:
            raise HTTPException(404, f"The plant knows no task {task_id!a}.")
        return JSONResponse(known)

    @app.post("/api/plant/{verb}")
    async def operate_plant(verb: str, request: Request) -> JSONResponse:
        return await operated(verb, "", request)

    @app.post("/api/cells/{scope}/{verb}")
    async def operate_one(scope: str, verb: str, request: Request) -> JSONResponse:
        return await operated(verb, scope, request)

    async def operated(word: str, scope: str, request: Request) -> JSONResponse:
        verb, by_hand = verb_of(word), said_by_hand(await request.body())
        answer = await in_time(operate(verb, scope, by_hand=by_hand))
        if answer.refusal is not None:
            return JSONResponse({"sentence": answer.refusal}, status_code=409)
        return JSONResponse({"verb": verb.value, "scope": scope})

    return app


async def in_time(answer: Future[Answer]) -> Answer:
    """What the plant answers; ArboledaError where it takes longer than ANSWER_S."""
    try:
        # the plant still sets its future after that, which a cancelled one does not allow
        return await asyncio.wait_for(asyncio.shield(asyncio.wrap_future(answer)), ANSWER_S)
    except asyncio.TimeoutError:
        raise ArboledaError(
            "The plant did not answer in time; see its state before sending this again."
        ) from None


def verb_of(word: str) -> Verb:
    """The operator's verb of that name; PayloadError where there is none."""
    try:
        return Verb(word)
    except ValueError:
        names = ", ".join(verb.value for verb in Verb)
        raise PayloadError(f"{word!a} is not an operator's verb; there are {names}.") from None


def said_by_hand(body: bytes) -> bool:
    """The value in `{"by_hand": true}`, False where there is no body; PayloadError for anything else."""
    try:
        said = json.loads(body or b"{}")
    except (ValueError, RecursionError):
        said = None
    if (
        not isinstance(said, dict)
        or said.keys() - {"by_hand"}
        or type(said.get("by_hand", False)) is not bool
    ):
        raise PayloadError('The body may be empty or JSON like {"by_hand": true}, and nothing else.')
    return said.get("by_hand", False)


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
