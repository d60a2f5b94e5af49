"""The page on many plants: a row for each, a task for any of them, and a stop for one or for all."""

from __future__ import annotations

import asyncio
import json
import logging
from contextlib import suppress

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse
from nicegui import Client, app, ui
from nicegui.events import GenericEventArguments

from arboleda.adapters.web.api import task_asked
from arboleda.adapters.web.auth import SUBMIT, Role, allowed, require
from arboleda.adapters.web.schema import TaskText
from arboleda.model.errors import PayloadError
from arboleda.model.messages import Verb

from .. import header, shell
from ..frames import Frames, ended
from ..plant_side import Layout
from ..shell import language_of, role_shown
from ..tags import act_button, rows, tag
from ..wording import Words, words
from .face import face
from .side import Asked, SiteSide

FRAME_S = 0.5
BEAT = 2  # frames after which pages are told that the site is there
LONGEST = 300  # characters of what a browser may name
COLUMNS = ("state", "plant", "why", "tasks", "ended", "oee")
SEEN = "seen"
LOG = logging.getLogger(__name__)


def mount(server: FastAPI, site: SiteSide) -> None:
    """Put the page at `/` of this app, with the stops that its buttons use; StartError where this process
    shows a page already."""
    frames, opened = Frames(), asyncio.Event()

    def build(request: Request, client: Client) -> None:
        said = words(language_of(request))
        desk = Desk(client, site, frames, said)
        ui.on("arboleda", desk.hear)
        client.on_connect(lambda: (frames.add(desk), opened.set()))
        client.on_delete(lambda: frames.remove(desk))
        role = role_shown(request)
        shell.fill(
            {"places": {"robots": []}},
            said,
            {"plants": _plants},
            script="site.js",
            header=lambda parts: header.of_site(said, parts, role),
        )

    _serve(server, site)
    shell.serve(server, {"plant": words("en")("site.title")}, build)
    _keep_running(site, frames, opened)


def _serve(server: FastAPI, site: SiteSide) -> None:
    async def stop(request: Request, plant: str = "") -> JSONResponse:
        """The software stop of one plant, or of all: 200 where each heard it, else 502 with those that did
        not."""
        require(request.scope["arboleda.role"], Verb.STOP.value)
        answer = await site.stop(plant)
        sentence = words(language_of(request)).say(answer.sentence)
        return JSONResponse({"sentence": sentence}, status_code=200 if answer.good else 502)

    async def add_task(request: Request) -> JSONResponse:
        """A task for the best of the plants that it names, `north/sis_a,south/sis_a 0B 7`, or refused."""
        require(request.scope["arboleda.role"], SUBMIT)
        asked = task_asked(await request.body())
        if not isinstance(asked, TaskText):
            raise PayloadError('The body must be JSON like {"text": "north/sis_a,south/sis_a 0B 7"}.')
        answer = await site.submit("", asked.text)
        sentence = words(language_of(request)).say(answer.sentence)
        return JSONResponse({"sentence": sentence}, status_code=202 if answer.good else 422)

    server.add_api_route("/api/tasks", add_task, methods=["POST"], include_in_schema=False)
    server.add_api_route("/api/plants/stop", stop, methods=["POST"], include_in_schema=False)
    server.add_api_route("/api/plants/{plant}/stop", stop, methods=["POST"], include_in_schema=False)


def _plants(_layout: Layout, said: Words) -> None:
    with tag("div", classes="box"):
        rows(
            "plants",
            [said(f"site.column.{name}") for name in COLUMNS],
            empty=said("site.none"),
            classes="plants",
        )
        tag("p", said("site.not_safety"), classes="hint")
    with tag("form", id="site-form", classes="box form"):
        tag("h2", said("tasks.new"))
        with tag("div", classes="send"):
            with tag("label", classes="text"):
                tag("span", said("site.column.plant"))
                tag("select", id="site-plant")
            with tag("label", classes="text"):
                tag("span", said("tasks.text"))
                tag("input", id="site-text", type="text", autocomplete="off", maxlength="200")
            act_button(
                said("tasks.send"), SUBMIT, "", said("site.send_does"), classes="primary", id="site-send"
            )
        tag("p", said("site.send_does"), classes="hint")


class Desk:
    """One open page: a viewer of the frames, and the way from its events to the plants."""

    def __init__(self, client: Client, site: SiteSide, frames: Frames, said: Words) -> None:
        self.language = said.language
        self._client, self._site, self._frames, self._words = client, site, frames, said

    @property
    def connected(self) -> bool:
        return self._client.has_socket_connection

    @property
    def _role(self) -> Role | None:
        return (self._client.environ or {}).get("asgi.scope", {}).get("arboleda.role")

    def show(self, number: int, patch: str) -> None:
        """Send one frame."""
        self._client.run_javascript(f"arboleda.live({number}, {patch})")

    async def hear(self, event: GenericEventArguments) -> None:
        """One event of the page: [act, of, text]; anything else is ignored."""
        asked = event.args if isinstance(event.args, list) else [event.args]
        act, of, text = [*asked, None, None, None][:3]
        if act == SEEN and isinstance(of, int):
            self._frames.seen(self, of)
        elif act in (SUBMIT, Verb.STOP.value) and isinstance(of, str) and len(of) <= LONGEST:
            await self._do(act, of, text if isinstance(text, str) else "")

    async def _do(self, act: str, plant: str, text: str) -> None:
        if not allowed(self._role, act):
            self._say(self._words("page.not_allowed", act=self._words.of("verb", act)), good=False)
            return
        answer: Asked
        if act == SUBMIT:
            answer = await self._site.submit(plant, text[:LONGEST])
        else:
            answer = await self._site.stop(plant)
        self._say(self._words.say(answer.sentence), good=answer.good)

    def _say(self, sentence: str, *, good: bool) -> None:
        self._client.run_javascript(f"arboleda.answer({json.dumps(sentence)}, {json.dumps(good)})")


def _keep_running(site: SiteSide, frames: Frames, opened: asyncio.Event) -> None:
    running: list[asyncio.Task[None]] = []

    async def run() -> None:
        number = 0
        while True:
            number += 1
            try:
                for language in frames.languages:
                    frames.send(language, face(site.plants(), words(language)), beat=number % BEAT == 0)
            except Exception:  # one frame that cannot be made does not end the page
                LOG.exception("a frame of the page failed")
            opened.clear()
            with suppress(asyncio.TimeoutError):  # who opens a page does not wait for the next frame
                await asyncio.wait_for(opened.wait(), FRAME_S)

    async def start() -> None:
        site.start()
        running.append(asyncio.create_task(run()))

    async def stop() -> None:
        await asyncio.gather(*map(ended, running))
        await site.close()

    app.on_startup(start)
    app.on_shutdown(stop)
