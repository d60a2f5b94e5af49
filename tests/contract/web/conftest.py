"""The real server before a plant that answers what a test prepared."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from typing import Any

import httpx
import pytest
from fastapi import FastAPI, WebSocket, WebSocketDisconnect

from arboleda.adapters.server_tls import ServerTls, pinned
from arboleda.core.leaving import stop_left
from arboleda.core.text import alternatives, spelled
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.verbs import Arguments
from arboleda.store.oee_rows import OeeQuery
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.testing import shipped
from arboleda.views.oee import KeptFigures, Oee, Run, Work, oee
from arboleda.web import limits
from arboleda.web.access.auth import Door, Role
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.api import make_app
from arboleda.web.server import SecondLoop, Server

from ...patience import PATIENCE_S

QUEUED = {"id": "t-1", "text": "sis_a 0b 7", "cell": "sis_a", "state": "queued", "sentence": ""}
PROMISE = {"hindrance": None, "full": False}
TASK = QUEUED | {"reason": None, "elapsed_s": None}
VIEW = {"plant": "demo", "epoch": 7, "at": 1.0, "ending": False, "cells": [], "robots": [], "zones": []}
VIEW |= {"tasks": [TASK]}
WIDTH = {"name": "width", "called": "width", "type": "choice", "choices": ["5"]}
OFFER = {
    "name": "cut",
    "about": "Cut it.",
    "default": False,
    "form": "<cell> cut <width>",
    "example": "saw cut 5",
}
OFFERS = [{"cell": "saw", "recipes": [OFFER | {"parameters": [WIDTH]}]}]
LATE = Phrase("late", "{robot} was late")(robot="ra1")
FAILED = Work(cell="sis_a", order="sis_a 0B 7", state="failed", accepted_s=0.0, started_s=0.0, ended_s=50.0)
RAN = Run(since_s=0.0, seen_s=100.0, ended=True)
FIGURES = KeptFigures(works=[FAILED], runs=[RAN], downs=[], shortest={})
KEPT = [
    TaskRow(
        number=number,
        id=f"t-{number}",
        text=f"{cell} 0B 7",
        cell=cell,
        recipe="storage",
        state="failed",
        reason="deadline",
        sentence=str(LATE),
        said=json.dumps(LATE.data()),
        accepted_s=1000.0 + number,
        started_s=1001.0 + number,
        ended_s=None,
        unchecked="release" if number == 2 else None,
    )
    for number, cell in ((2, "sis_b"), (1, "sis_a"))
]
TOKENS = {Role.VIEWER: "v" * 32, Role.OPERATOR: "o" * 32}


class Plant:
    """Answers each text with what was prepared for it."""

    def __init__(self) -> None:
        self.teach: Any = None
        self.reports: Iterator[str | None] = iter(())
        self.texts: list[str] = []
        self.choices: list[str] = []
        self.seconds = 60.0
        self.asked_by: list[str] = []
        self.forms: list[tuple] = []
        self.queries: list[TaskQuery] = []
        self.oee_queries: list[OeeQuery] = []
        self.answer: dict | Exception | None = QUEUED
        self.view: dict | Exception = VIEW
        self.acts: list[tuple[Verb, str, bool]] = []
        self.refusal: str | None = None
        self.unkept: Sentence | None = None  # why a stop that has left is not kept
        self.told: dict = {}  # of the answer to an act that is not refused
        self.rows: dict[int, dict] = {}
        self.unanswered: list[Future] | None = None
        self.watchers: list[Callable[[dict], None]] = []

    def snapshot(self) -> dict:
        if isinstance(self.view, Exception):
            raise self.view
        return self.view

    def latest(self) -> dict:
        return self.snapshot()

    def offers(self) -> list[dict]:
        return OFFERS

    def spelled(self, *, cell: str, recipe: str, values: dict, id: str) -> str:
        self.forms.append((cell, recipe, values, id))
        return spelled(shipped(), cell=cell, recipe=recipe, values=values, id=id)

    def find(self, task: str) -> dict | None:
        return QUEUED if task == QUEUED["id"] else None

    def history(self, query: TaskQuery) -> list[TaskRow]:
        self.queries.append(query)
        return [row for row in KEPT if query.cell in ("", row.cell)]

    def report(self, task: str) -> str | None:
        return next(self.reports)

    def oee(self, query: OeeQuery) -> list[Oee]:
        self.oee_queries.append(query)
        return [oee("sis_a", FIGURES, 0.0, 100.0)]

    def promises(self, text: str) -> list[dict]:
        return [
            {**PROMISE, "text": each.text, "cell": each.cell, "seconds": self.seconds}
            for each in alternatives(text, shipped())
        ]

    def submit(self, text: str, asked_by: str, choice: str = "") -> Future:
        self.texts.append(text)
        self.choices.append(choice)
        self.asked_by.append(asked_by)
        future: Future = Future()
        if isinstance(self.answer, Exception):
            future.set_exception(self.answer)
        elif self.answer is not None:
            future.set_result(self.answer)
        return future

    def operate(self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()) -> Future:
        self.acts.append((verb, scope, by_hand, *arguments))
        future: Future = Future()
        if self.unanswered is not None:
            self.unanswered.append(future)
        else:
            answer = OperatorAnswer(verb=verb, scope=scope, refusal=self.refusal, **self.told)
            future.set_result(answer if self.unkept is None else stop_left(answer, self.unkept))
        return future

    def act(self, number: int) -> dict | None:
        return self.rows.get(number)

    def watch(self, callback: Callable[[dict], None]) -> Callable[[], None]:
        self.watchers.append(callback)
        return lambda: self.watchers.remove(callback)

    def becomes(self, **keys: Any) -> None:
        """The plant has stepped: it has these keys now, and tells its watchers."""
        self.view = {**self.view, "at": self.view["at"] + 1, **keys}
        for watcher in self.watchers:
            watcher(self.view)


class Web:
    """A running server: where, and clients of it."""

    def __init__(self, server: Server, door: Door, tls: ServerTls | None = None) -> None:
        self.port = port = server.start()
        self.server = server
        self.door = door
        self.origin = f"{'https' if tls else 'http'}://127.0.0.1:{port}"
        self.believing = pinned(tls.pem) if tls else True
        self.cookie = f"arboleda_{port}"
        self._clients: list[httpx.Client] = []

    def client(self, *, token: Role | None = None, login: Role | None = None, **headers: str) -> httpx.Client:
        """Somebody with a token, a tool; or with a session, a browser; or with neither."""
        if token is not None:
            headers["authorization"] = f"Bearer {TOKENS[token]}"
        made = httpx.Client(
            base_url=self.origin,
            trust_env=False,
            headers=headers,
            timeout=PATIENCE_S,
            verify=self.believing,
        )
        if login is not None:
            made.headers["origin"] = self.origin
            made.cookies.set(self.cookie, self.session(login))
        self._clients.append(made)
        return made

    def session(self, role: Role) -> str:
        session = self.door.log_in(TOKENS[role].encode())
        assert session
        return session

    def close(self) -> None:
        for client in self._clients:
            client.close()


def echo(app: FastAPI) -> None:
    """A websocket that says who is there and repeats what it hears, as a page's socket would."""

    @app.websocket("/_page/socket")
    async def socket(socket: WebSocket) -> None:
        await socket.accept()
        await socket.send_text(socket.scope["arboleda.role"].value)
        try:
            while True:
                await socket.send_text(await socket.receive_text())
        except WebSocketDisconnect:
            pass


@pytest.fixture
def plant() -> Plant:
    return Plant()


@contextmanager
def running(
    plant: Plant,
    tokens: dict[Role, str] | None = None,
    public_url: str | None = None,
    mount: Callable[[FastAPI], None] = echo,
    sockets: int = limits.SOCKETS,
    streams: int = limits.STREAMS,
    tls: ServerTls | None = None,
    name: str = "",
    **options: Any,
) -> Iterator[Web]:
    """As on one's own machine; with tokens as on a network. Both listen to 127.0.0.1. `mount` adds pages,
    `name` is the plant's."""
    door = Door((lambda: tokens) if tokens else None)
    app = make_app(plant, streams=streams)
    mount(app)
    bound = "0.0.0.0" if tokens and not public_url else "127.0.0.1"
    names = names_for(bound, public_url, scheme="https" if tls else "http")
    guarded = Guard(SecondLoop(app), names, door, sockets=sockets, plant=name)
    server = Server(guarded, **{"port": 0, **options}, tls=tls)
    web = Web(server, door, tls)
    try:
        yield web
    finally:
        web.close()
        server.stop()


@pytest.fixture
def serve(plant: Plant) -> Iterator[Callable[..., Web]]:
    """`serve()`, `serve(tokens)`: see `running`."""
    with ExitStack() as stack:
        yield lambda *args, **options: stack.enter_context(running(plant, *args, **options))


@pytest.fixture
def local(serve: Callable[..., Web]) -> Web:
    """A plant on one's own machine."""
    return serve()


@pytest.fixture
def open_to_all(serve: Callable[..., Web]) -> Web:
    """A plant on a network."""
    return serve(dict(TOKENS))


@pytest.fixture
def port(local: Web) -> int:
    return local.port


@pytest.fixture
def web(local: Web) -> httpx.Client:
    return local.client()


@pytest.fixture(scope="module")
def plant_once() -> Plant:
    return Plant()


@pytest.fixture(scope="module")
def open_to_all_once(plant_once: Plant) -> Iterator[Web]:
    """A plant on a network for all rows of a table."""
    with running(plant_once, dict(TOKENS)) as web:
        yield web
