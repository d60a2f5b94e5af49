"""The page on many plants: a row for each, a task for any of them, and a stop for one or for all."""

from __future__ import annotations

import asyncio
import logging
import time
from contextlib import suppress

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse

from arboleda.dashboard import header, shell
from arboleda.dashboard.body import Parts, body
from arboleda.dashboard.frames import Background, Frames
from arboleda.dashboard.open_page import LONGEST, OpenPage
from arboleda.dashboard.shell import language_of, role_shown
from arboleda.dashboard.toolkit import Client, app, ui
from arboleda.extension import Assets, Layout, PayloadError, Words, act_button, rows, tag, words
from arboleda.model.messages import Verb
from arboleda.web.access.auth import SUBMIT, allowed, require
from arboleda.web.api import task_in
from arboleda.web.schema.bodies import TaskText

from .face import face
from .side import RequestOutcome, SiteSide

FRAME_S = 0.5
COLUMNS = ("state", "plant", "why", "tasks", "ended", "oee")
ASSETS = Assets(package="arboleda_fleet.page", styles=("fleet",))
LOG = logging.getLogger(__name__)


def mount(server: FastAPI, site: SiteSide) -> None:
    """Put the page at `/` of this app, with the stops that its buttons use; StartError where this process
    shows a page already."""
    frames, opened = Frames(), asyncio.Event()

    def build(request: Request, client: Client) -> str:
        wording = words(language_of(request))
        desk = Desk(client, site, frames, wording)
        ui.on("arboleda", desk.hear)
        client.on_connect(lambda: frames.add(desk))
        client.on_connect(opened.set)
        client.on_delete(lambda: frames.remove(desk))
        role = role_shown(request)
        shell.fill(NOTHING_DRAWN, wording, script=ASSETS.of("site.js"), added=[ASSETS])
        return body(
            NOTHING_DRAWN, wording, PARTS, header=lambda places: header.of_site(wording, places, role)
        )

    _serve(server, site)
    shell.serve(server, {"plant": words("en")("site.title")}, build, [ASSETS])
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
        """Give a task to the best of the plants it names, `north/sis_a,south/sis_a 0B 7`, or refuse it."""
        require(request.scope["arboleda.role"], SUBMIT)
        form = task_in(await request.body())
        if not isinstance(form, TaskText):
            raise PayloadError('The body must be JSON like {"text": "north/sis_a,south/sis_a 0B 7"}.')
        answer = await site.submit("", form.text)
        sentence = words(language_of(request)).say(answer.sentence)
        return JSONResponse({"sentence": sentence}, status_code=202 if answer.good else 422)

    server.add_api_route("/api/tasks", add_task, methods=["POST"], include_in_schema=False)
    server.add_api_route("/api/plants/stop", stop, methods=["POST"], include_in_schema=False)
    server.add_api_route("/api/plants/{plant}/stop", stop, methods=["POST"], include_in_schema=False)


def _plants(_layout: Layout, wording: Words) -> None:
    with tag("div", classes="box"):
        rows(
            "plants",
            [wording(f"site.column.{name}") for name in COLUMNS],
            empty=wording("site.none"),
            classes="plants",
        )
        tag("p", wording("site.not_safety"), classes="hint")
    with tag("form", id="site-form", classes="box form"):
        tag("h2", wording("tasks.new"))
        with tag("div", classes="send"):
            with tag("label", classes="text"):
                tag("span", wording("site.column.plant"))
                tag("select", id="site-plant")
            with tag("label", classes="text"):
                tag("span", wording("tasks.text"))
                tag("input", id="site-text", type="text", autocomplete="off", maxlength="200")
            act_button(
                wording("tasks.send"),
                SUBMIT,
                "",
                wording("site.send_does"),
                classes="primary",
                id="site-send",
            )
        tag("p", wording("site.send_does"), classes="hint")


NOTHING_DRAWN: Layout = {"places": {"robots": []}}
PARTS: Parts = {"plants": _plants}


class Desk(OpenPage):
    """Desk: the way from the events of a page to the plants."""

    def __init__(self, client: Client, site: SiteSide, frames: Frames, wording: Words) -> None:
        super().__init__(client, wording, frames.note_shown)
        self._site = site

    async def take(self, act: str, of: str, more: object) -> None:
        """Send a task to the plant `of`, whose text is `more`, or stop that plant."""
        if act not in (SUBMIT, Verb.STOP.value):
            return
        if not allowed(self.role, act):
            self.say(self._words("page.not_allowed", act=self._words.of("verb", act)), good=False)
            return
        answer: RequestOutcome
        if act == SUBMIT:
            answer = await self._site.submit(of, more[:LONGEST] if isinstance(more, str) else "")
        else:
            answer = await self._site.stop(of)
        self.say(self._words.say(answer.sentence), good=answer.good)


def _keep_running(site: SiteSide, frames: Frames, opened: asyncio.Event) -> None:
    async def run() -> None:
        while True:
            try:
                for language in frames.languages:
                    frames.send(language, face(site.plants(), words(language)), time.monotonic())
            except Exception:  # one frame that cannot be made does not end the page
                LOG.exception("a frame of the page failed")
            opened.clear()
            with suppress(asyncio.TimeoutError):  # a page that opens does not wait for the next frame
                await asyncio.wait_for(opened.wait(), FRAME_S)

    background = Background(run)

    async def start() -> None:
        site.start()
        background.start()

    async def stop() -> None:
        await background.stop()
        await site.close()

    app.on_startup(start)
    app.on_shutdown(stop)
