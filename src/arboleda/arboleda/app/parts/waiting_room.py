"""What a standby shows while it waits: a page and an API that say so, behind the same door as the plant's."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Route

from arboleda.adapters.web import limits
from arboleda.adapters.web.auth import Door
from arboleda.adapters.web.guard import Guard
from arboleda.adapters.web.names import names_for
from arboleda.adapters.web.server import Server

from .. import tokens
from ..web_options import WebOptions
from .web import Announce

PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta http-equiv="refresh" content="2">
<meta name="viewport" content="width=device-width"><title>{plant}: standby</title>
<style>body{{font:1.1rem sans-serif;max-width:40rem;margin:4rem auto;padding:0 1rem}}</style></head>
<body><main><h1>{plant}</h1>
<p>This process stands by. It {sentence}.</p>
<p lang="es">Este proceso está en reserva: toma la planta cuando termina el que la dirige.</p>
{link}</main></body></html>
"""
LINK = (
    '<p><a href="{url}">The page of the plant</a> · <a href="{url}" lang="es">La página de la planta</a></p>'
)


class WaitingRoom:
    """A server for the time of waiting; it shows what it was told last."""

    def __init__(self, plant: str, state: Path, options: WebOptions) -> None:
        self._plant, self._state, self._options = plant, state, options
        self._sentence, self._url, self._port = "begins to wait", "", 0
        routes = [
            Route("/", self._page),
            Route("/api/plant", self._status),
            Route("/{rest:path}", self._refuse, methods=["GET", "POST", "PUT", "DELETE"]),
        ]
        door = Door(tokens.TokenFile(state) if options.guarded else None)
        names = names_for(options.address, options.public_url, scheme=options.scheme)
        app = Guard(Starlette(routes=routes), names, door, sockets=limits.SOCKETS)
        self._server = Server(app, host=options.address, port=options.port, tls=options.tls)

    @property
    def address(self) -> str:
        """Where its page is, for this machine."""
        return f"Page of the standby: {self._options.scheme}://{self._options.near}:{self._port}"

    def show(self, sentence: str, url: str) -> None:
        """What it waits for, and the page of the leader, "" where that is not known."""
        self._sentence, self._url = sentence, url

    def start(self, announce: Announce) -> None:
        if self._options.guarded:
            tokens.read(self._state)
        self._port = self._server.start()
        certificate = self._options.tls.pem if self._options.tls else ""
        announce(self._port, host=self._options.near, guarded=self._options.guarded, certificate=certificate)

    def stop(self) -> None:
        self._server.stop()

    @property
    def _known(self) -> dict[str, Any]:
        return {"plant": self._plant, "standby": True, "sentence": self._sentence, "leader": self._url}

    async def _status(self, request: Request) -> Response:
        return JSONResponse(self._known)

    async def _page(self, request: Request) -> Response:
        is_page = self._url.startswith(("http://", "https://"))
        link = LINK.format(url=escape(self._url)) if is_page else ""
        sentence, plant = escape(self._sentence), escape(self._plant)
        return HTMLResponse(PAGE.format(plant=plant, sentence=sentence, link=link))

    async def _refuse(self, request: Request) -> Response:
        return JSONResponse(
            {"sentence": f"this process stands by and does nothing itself: it {self._sentence}"},
            status_code=503,
        )
