"""The HTTP server as a part, and the plant as it sees it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import Any, Protocol
from urllib.parse import urlencode

from fastapi import FastAPI

from arboleda.model.errors import QueueFull
from arboleda.model.facts import Value
from arboleda.model.messages import OperatorAnswer, TaskChanged, Verb
from arboleda.store.oee_rows import OeeQuery
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.views import view
from arboleda.views.oee import Oee
from arboleda.web import limits
from arboleda.web.api import make_app
from arboleda.web.guard import Guard
from arboleda.web.names import DEFAULT_PORT, is_loopback, names_for
from arboleda.web.plant_side import Snapshot
from arboleda.web.second_loop import SecondLoop
from arboleda.web.server import Server

from .. import tokens
from ..web_options import WebOptions
from .orchestrator import GLANCE_S, READ_S

LOG = logging.getLogger(__name__)
CLEAR = "No TLS: the token travels in clear on {host}; see docs/how-to/network.md"


class PlantAccess(Protocol):
    """What the part asks of the plant it belongs to."""

    def snapshot(self, within_s: float = READ_S) -> Snapshot: ...
    def offers(self) -> list[dict[str, Any]]: ...
    def find(self, task: str) -> dict[str, Any] | None: ...
    def history(self, query: TaskQuery) -> list[TaskRow]: ...
    def oee(self, query: OeeQuery) -> list[Oee]: ...
    def spelled(self, *, cell: str, recipe: str, values: Mapping[str, Value], id: str) -> str: ...
    def submit(self, text: str, asked_by: str, choice: str = "") -> Future[TaskChanged]: ...
    def promises(self, text: str) -> list[dict[str, Any]]: ...
    def operate(self, verb: Verb, scope: str = "", *, by_hand: bool = False) -> Future[OperatorAnswer]: ...
    def act(self, number: int) -> dict[str, Any] | None: ...


class Announce(Protocol):
    """Tells other processes of this machine where the server is reached."""

    def __call__(self, port: int, *, host: str, guarded: bool, certificate: str) -> None: ...


class Side:
    """The plant side of the API and of pages."""

    def __init__(self, plant: PlantAccess) -> None:
        self._plant = plant
        self._watchers: tuple[Callable[[Snapshot], None], ...] = ()
        self._changing = threading.Lock()
        self.snapshot = partial(plant.snapshot, GLANCE_S)
        self.latest = plant.snapshot
        self.offers = plant.offers
        self.find = plant.find
        self.history = plant.history
        self.oee = plant.oee
        self.spelled = plant.spelled
        self.promises = plant.promises
        self.operate = plant.operate
        self.act = plant.act

    def submit(self, text: str, asked_by: str, choice: str = "") -> Future[dict[str, Any]]:
        plain: Future[dict[str, Any]] = Future()
        self._plant.submit(text, asked_by, choice).add_done_callback(lambda answer: _pass_on(answer, plain))
        return plain

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        with self._changing:
            self._watchers = (*self._watchers, callback)
        return lambda: self._forget(callback)

    def saw(self, snapshot: Snapshot) -> None:
        """Tell every watcher, in the plant's thread; one that fails is told no more."""
        for callback in self._watchers:
            try:
                callback(snapshot)
            except Exception as error:  # noqa: BLE001 - whatever a screen does, the plant goes on
                LOG.error("a watcher of the plant failed and is told no more: %r", error)
                self._forget(callback)

    def _forget(self, callback: Callable[[Snapshot], None]) -> None:
        with self._changing:
            self._watchers = tuple(each for each in self._watchers if each is not callback)


class WebPart:
    """Serves the API, and the pages that `mount(app, side)` adds; has its address announced."""

    def __init__(
        self,
        plant: PlantAccess,
        name: str,
        state: Path,
        announce: Announce,
        options: WebOptions,
        mount: Callable[[FastAPI, Side], None] | None = None,
        *,
        connections: int = limits.CONNECTIONS,
        counts: Callable[[], bytes] | None = None,
    ) -> None:
        self.side = Side(plant)
        self._options = options
        self._state = state
        self._announce = announce
        self._port = 0
        self._shows_page = mount is not None
        app = make_app(self.side, streams=limits.lasting(limits.STREAMS, connections), counts=counts)
        if mount is not None:
            mount(app, self.side)
        sockets = limits.lasting(limits.SOCKETS, connections)
        names = names_for(options.address, options.public_url, scheme=options.scheme)
        guarded = Guard(SecondLoop(app), names, options.door_of(state), sockets=sockets, plant=name)
        self._server = Server(
            guarded,
            host=options.address,
            port=options.port,
            usual_port=options.usual_port,
            connections=connections,
            tls=options.tls,
        )

    @property
    def notes(self) -> list[str]:
        """What a person should know, a line each."""
        address = self._here
        notes = [f"HTTP API: {address}/api/plant"]
        if self._options.port is None and self._port != DEFAULT_PORT:
            notes[0] += f" (port {DEFAULT_PORT} is taken)"
        if self._shows_page:
            notes.insert(0, f"Page: {address}")
        if self._options.guarded:
            notes.append(f"Tokens: {self._state / tokens.TOKENS}; arboleda token shows them")
        if not is_loopback(self._options.host) and self._options.tls is None:
            notes.append(CLEAR.format(host=self._options.host))
        return notes

    def address_of(self, cell: str, task: str | None) -> str | None:
        """Where a browser sees a cell, or a task of it; None where there is no page."""
        if not self._shows_page:
            return None
        place = {"tab": "cells", "cell": cell} if task is None else {"tab": "tasks", "task": task}
        origin = self._options.public_url or self._here
        return f"{origin}/?{urlencode(place)}"

    @property
    def _here(self) -> str:
        """Its origin, for this machine."""
        return f"{self._options.scheme}://{self._options.near}:{self._port}"

    def start(self) -> None:
        if self._options.guarded:
            tokens.read(self._state)
        self._port = self._server.start()
        self._announce(
            self._port,
            host=self._options.near,
            guarded=self._options.guarded,
            certificate=self._options.tls.pem if self._options.tls else "",
        )

    def stop(self) -> None:
        self._server.stop()


def _pass_on(answer: Future[TaskChanged], plain: Future[dict[str, Any]]) -> None:
    error = answer.exception()
    if error is not None:
        plain.set_exception(error)
    elif answer.result().for_now:
        plain.set_exception(QueueFull(answer.result().sentence))
    else:
        plain.set_result(view.change(answer.result()))
