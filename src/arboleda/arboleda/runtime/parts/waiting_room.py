"""Waiting room of a standby: a page and an API that say that it waits, with the same login as the plant's."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

from fastapi import FastAPI
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Route

from arboleda.web import limits, login
from arboleda.web.guard import Guard
from arboleda.web.names import names_for
from arboleda.web.request import API
from arboleda.web.server import Server

from .. import tokens
from ..leader import LeaderInfo, said_of
from ..web_options import WebOptions
from .web import Announce

SOON_S = "1"  # Retry-After: within seconds somebody leads
METHODS = ["GET", "POST", "PUT", "PATCH", "DELETE"]
IN_AN_ADDRESS = ":/%#?=@[]!$&'()*+,;"  # characters that are not quoted
# It looks again and again, and is loaded anew where something else is said: then also where the plant's own
# page is there in its place. A page that was loaded anew by the clock would be lost in the second in between.
PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>{plant}: standby</title>
<noscript><meta http-equiv="refresh" content="2"></noscript>
<style>body{{font:1.1rem sans-serif;max-width:40rem;margin:4rem auto;padding:0 1rem}}</style></head>
<body><main data-sentence="{sentence}"><h1>{plant}</h1>
<p>This process stands by. It {sentence}. This page becomes that of the plant once it leads.</p>
<p lang="es">Este proceso está en reserva: toma la planta cuando termina el que la dirige. Esta página pasa
entonces a ser la de la planta.</p>
{way}
<p id="lost" hidden role="status">This process gives no answer: what you see is old.
<span lang="es">Este proceso no responde: lo que ve es antiguo.</span></p></main>
<script>
const LOOK_MS = 1000, PATIENCE_MS = 3000, OLD_MS = 5000;
const known = document.querySelector("main").dataset.sentence;
let heardAt = Date.now();
async function look() {{
  try {{
    const answer = await fetch("/api/plant", {{ signal: AbortSignal.timeout(PATIENCE_MS) }});
    const isNews = answer.status === 401 || (answer.ok && (await answer.json()).sentence !== known);
    if (isNews) return location.reload();
    heardAt = Date.now();
  }} catch {{}}
  document.getElementById("lost").hidden = Date.now() - heardAt < OLD_MS;
  setTimeout(look, LOOK_MS);
}}
look();
</script></body></html>
"""
LINK = (
    '<p><a href="{url}">The page of the plant</a> · <a href="{url}" lang="es">La página de la planta</a></p>'
)
FAR = (
    "<p>Only {host} reaches that page.</p>"
    '<p lang="es">A la página de la planta solo se llega desde {host}.</p>'
)


class WaitingRoom:
    """WaitingRoom: a server for the time of waiting; it shows the last sentence given to `show`."""

    def __init__(self, plant: str, state: Path, options: WebOptions) -> None:
        self._plant, self._state, self._options = plant, state, options
        self._sentence, self._led = "begins to wait", None
        self.port = 0
        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None, redirect_slashes=False)
        app.include_router(login.routes())
        app.router.routes += [
            Route("/", self._page),
            Route("/api/plant", self._status),
            Route("/{rest:path}", self._send_on, methods=METHODS),
        ]
        names = names_for(options.address, options.public_url, scheme=options.scheme)
        guarded = Guard(app, names, options.door_of(state), sockets=limits.SOCKETS, plant=plant)
        self._server = Server(
            guarded,
            host=options.address,
            port=options.port,
            usual_port=options.usual_port,
            tls=options.tls,
        )

    @property
    def url(self) -> str:
        """The server's origin, for this machine."""
        return f"{self._options.scheme}://{self._options.near}:{self.port}"

    def show(self, sentence: str, led: LeaderInfo | None) -> None:
        """Show the reason for waiting and the leader, None if that one is unknown."""
        self._sentence, self._led = sentence, led

    def start(self, announce: Announce) -> None:
        if self._options.guarded:
            tokens.read(self._state)
        self.port = self._server.start()
        certificate = self._options.tls.pem if self._options.tls else ""
        announce(self.port, host=self._options.near, guarded=self._options.guarded, certificate=certificate)

    def stop(self) -> None:
        self._server.stop()

    @property
    def _known(self) -> dict[str, Any]:
        known = {"plant": self._plant, "standby": True, "sentence": self._sentence}
        return known | said_of(self._led)

    async def _status(self, request: Request) -> Response:
        return JSONResponse(self._known)

    async def _page(self, request: Request) -> Response:
        sentence, plant = escape(self._sentence), escape(self._plant)
        return HTMLResponse(PAGE.format(plant=plant, sentence=sentence, way=_way(self._led)))

    async def _send_on(self, request: Request) -> Response:
        """The answer to a request: a redirect to the leader for one of the API; 503 for any other one, or if
        the leader has no other address: it may be repeated."""
        sentence = f"this process stands by and does nothing itself: it {self._sentence}"
        said = self._known | {"sentence": sentence}
        way = self._led.way if self._led else ""
        # Behind a name that both hosts share the proxy asks the other one, where this one is unavailable.
        if not way or way in (self._options.public_url, self.url) or not request.url.path.startswith(API):
            return JSONResponse(said, status_code=503, headers={"retry-after": SOON_S})
        return JSONResponse(said, status_code=307, headers={"location": f"{way}{_target(request)}"})


def _target(request: Request) -> str:
    """The path and query of a request, as they were sent."""
    query = request.scope["query_string"]
    sent = request.scope["raw_path"] + (b"?" + query if query else b"")
    return quote(sent.decode("latin-1"), safe=IN_AN_ADDRESS)


def _way(led: LeaderInfo | None) -> str:
    """The link to the plant's page."""
    if led is None or not led.url:
        return ""
    return FAR.format(host=escape(led.host)) if led.is_far else LINK.format(url=escape(led.url))
