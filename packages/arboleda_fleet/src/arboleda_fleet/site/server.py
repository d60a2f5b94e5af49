"""Server of a site's page, with the same login as a plant's."""

from __future__ import annotations

import threading
from pathlib import Path

from fastapi import FastAPI

from arboleda.runtime import tokens
from arboleda.runtime.endpoints import Find
from arboleda.runtime.interrupts import interruptible, until, until_interrupted
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access import login
from arboleda.web.access.auth import Door
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.api import answer_in_sentences
from arboleda.web.server import Server

from . import page
from .watch import Site


class SiteServer:
    """SiteServer: serves from `start`, which returns the notes for a person, to `stop`. `state` keeps the
    tokens of the page if it is open to a network."""

    def __init__(self, find: Find, options: WebOptions, state: Path) -> None:
        self._options, self._state = options, state
        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None, redirect_slashes=False)
        answer_in_sentences(app)
        app.include_router(login.routes())
        page.mount(app, Site(find))
        door = Door(tokens.TokenFile(state) if options.guarded else None)
        names = names_for(options.address, options.public_url, scheme=options.scheme)
        self._server = Server(
            Guard(app, names, door), host=options.address, port=options.port, tls=options.tls
        )

    def start(self) -> list[str]:
        if self._options.guarded:
            tokens.read(self._state)
        port = self._server.start()
        lines = [f"Page: {self._options.origin(port)}"]
        return [*lines, f"Tokens: {self._state / tokens.TOKENS}"] if self._options.guarded else lines

    def stop(self) -> None:
        self._server.stop()


def serve(find: Find, options: WebOptions, state: Path) -> None:
    """Show the page until Ctrl-C."""
    server = SiteServer(find, options, state)
    with interruptible():
        try:
            for line in server.start():
                print(line, flush=True)
            print("Ctrl-C ends it; the plants go on.", flush=True)
            with until_interrupted():
                until(threading.Event())
        finally:
            server.stop()
