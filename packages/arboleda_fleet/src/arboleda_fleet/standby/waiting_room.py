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

from arboleda.runtime import tokens
from arboleda.runtime.leader import LeaderInfo, leader_row
from arboleda.runtime.parts.web import Announce
from arboleda.runtime.web_options import WebOptions
from arboleda.web import limits
from arboleda.web.access import login
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.languages import LANGUAGES, texts
from arboleda.web.request import API
from arboleda.web.server import Server

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
{stands_by}
{way}
<p id="lost" hidden role="status">{lost}</p></main>
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


def waiting_page(plant: str, sentence: str, led: LeaderInfo | None) -> str:
    """The page of a process that waits to lead a plant, in every language."""
    escaped, stands_by = escape(sentence), _each("stands_by")
    return PAGE.format(
        plant=escape(plant),
        sentence=escaped,
        stands_by="\n".join(_of(each, "p", text.format(sentence=escaped)) for each, text in stands_by),
        way=_way(led),
        lost="\n".join(_of(each, "span", text) for each, text in _each("lost")),
    )


def _each(key: str) -> list[tuple[str, str]]:
    """A text of the page in every language, with the language."""
    return [(each, texts(each, "waiting")[key]) for each in LANGUAGES]


def _of(language: str, tag: str, text: str) -> str:
    return f'<{tag} lang="{language}">{text}</{tag}>'


class WaitingRoom:
    """WaitingRoom: a server for the time of waiting; it shows the last sentence given to `show`.

    `app` is what it serves.
    """

    def __init__(self, plant: str, state: Path, options: WebOptions) -> None:
        self._plant, self._state, self._options = plant, state, options
        self._sentence = "begins to wait"
        self._led: LeaderInfo | None = None
        self.port = 0
        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None, redirect_slashes=False)
        app.include_router(login.routes())
        app.router.routes += [
            Route("/", self._page),
            Route("/api/plant", self._status),
            Route("/{rest:path}", self._send_on, methods=METHODS),
        ]
        names = names_for(options.address, options.public_url, scheme=options.scheme)
        self.app = Guard(app, names, options.door_of(state), sockets=limits.SOCKETS, plant=plant)
        self._server = Server(
            self.app,
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
        self._sentence = sentence
        self._led = led

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
        return known | leader_row(self._led)

    async def _status(self, request: Request) -> Response:
        return JSONResponse(self._known)

    async def _page(self, request: Request) -> Response:
        return HTMLResponse(waiting_page(self._plant, self._sentence, self._led))

    async def _send_on(self, request: Request) -> Response:
        """The answer to a request: a redirect to the leader for one of the API; 503 for any other one, or if
        the leader has no other address: it may be repeated."""
        sentence = f"this process stands by and does nothing itself: it {self._sentence}"
        answer = self._known | {"sentence": sentence}
        way = self._led.way if self._led else ""
        # Behind a name that both hosts share the proxy asks the other one, where this one is unavailable.
        if not way or way in (self._options.public_url, self.url) or not request.url.path.startswith(API):
            return JSONResponse(answer, status_code=503, headers={"retry-after": SOON_S})
        return JSONResponse(answer, status_code=307, headers={"location": f"{way}{_target(request)}"})


def _target(request: Request) -> str:
    """The path and query of a request, as they were sent."""
    query = request.scope["query_string"]
    sent = request.scope["raw_path"] + (b"?" + query if query else b"")
    return quote(sent.decode("latin-1"), safe=IN_AN_ADDRESS)


def _way(led: LeaderInfo | None) -> str:
    """The link to the plant's page."""
    if led is None or not led.url:
        return ""
    if led.is_far:
        host = escape(led.host)
        return "".join(_of(each, "p", text.format(host=host)) for each, text in _each("far"))
    url = escape(led.url)
    links = (f'<a href="{url}" lang="{each}">{text}</a>' for each, text in _each("link"))
    return f"<p>{' · '.join(links)}</p>"
