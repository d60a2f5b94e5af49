"""The HTTP server as a part, and the plant as it sees it."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path
from typing import Protocol
from urllib.parse import urlencode

from fastapi import FastAPI

from arboleda.host.pieces import Pieces
from arboleda.web import limits
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import DEFAULT_PORT, is_loopback, names_for
from arboleda.web.api import make_app
from arboleda.web.package_routes import taking
from arboleda.web.second_loop import SecondLoop
from arboleda.web.server import Server

from .. import tokens
from ..web_options import WebOptions
from .local_plant import LocalPlant

LOG = logging.getLogger(__name__)
CLEAR = "No TLS: the token travels in clear on {host}; see docs/how-to/network.md"


class Announce(Protocol):
    """The function that tells other processes of this machine the server's address."""

    def __call__(self, port: int, *, host: str, guarded: bool, certificate: str) -> None: ...


class WebPart:
    """Serves the API, and the pages that `mount(app)` adds; has its address announced."""

    def __init__(
        self,
        plant: LocalPlant,
        name: str,
        state: Path,
        announce: Announce,
        options: WebOptions,
        mount: Callable[[FastAPI], None] | None = None,
        *,
        connections: int = limits.CONNECTIONS,
        counts: Callable[[], bytes] | None = None,
        pieces: Pieces | None = None,
    ) -> None:
        self.plant = plant
        self._options = options
        self._state = state
        self._announce = announce
        self._port = 0
        self._shows_page = mount is not None
        streams = limits.lasting(limits.STREAMS, connections)
        app = make_app(self.plant, streams=streams, counts=counts, pieces=pieces)
        if mount is not None:
            mount(app)
        sockets = limits.lasting(limits.SOCKETS, connections)
        names = names_for(options.address, options.public_url, scheme=options.scheme)
        guarded = Guard(
            SecondLoop(app),
            names,
            options.door_of(state),
            sockets=sockets,
            plant=name,
            takes=taking(app),
        )
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
        """The lines that a person should read about the server."""
        notes = [f"HTTP API: {self._options.direct(self._port)}/api/plant"]
        if self._options.port is None and self._port != DEFAULT_PORT:
            notes[0] += f" (port {DEFAULT_PORT} is taken)"
        if self._shows_page:
            notes.insert(0, f"Page: {self._options.origin(self._port)}")
        if self._options.guarded:
            notes.append(f"Tokens: {self._state / tokens.TOKENS}; arboleda token shows them")
        if not is_loopback(self._options.host) and self._options.tls is None:
            notes.append(CLEAR.format(host=self._options.host))
        return notes

    @property
    def port(self) -> int:
        return self._port

    def address_of(self, cell: str, task: str | None) -> str | None:
        if not self._shows_page:
            return None
        place = {"tab": "cells", "cell": cell} if task is None else {"tab": "tasks", "task": task}
        return f"{self._options.origin(self._port)}/?{urlencode(place)}"

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
