"""The page of a plant that runs: header with the big stop, the parts below it, and its mounting."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import Annotated

from fastapi import FastAPI, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse

from arboleda.host.pieces import Pieces
from arboleda.model.packages import FLEET, MAKE, MISSING, PROOFS
from arboleda.model.sentence import Phrase
from arboleda.store.task_rows import TaskQuery
from arboleda.web.request import HISTORY, TASK

from . import header, links, menu, settings, shell, tasks, timeline, trees
from .added import PAST, AddedParts, installed
from .added_sections import LeftOut
from .asset_files import own
from .body import WITHIN, Parts, Places, body
from .desk import Desk
from .faces import history
from .feed import Feed
from .frames import Background
from .page_api import Layout, PageApi, Seen
from .page_part import Place, Put
from .shell import language_of, role_shown
from .tags import tag
from .toolkit import Client, app, ui
from .twin import window
from .twin.show import Show
from .wording import Words, words

OWN = ("cells", "tasks", "events", "links", "settings")
WHAT = {
    FLEET: Phrase("package.oee", "The OEE of the cells"),
    MAKE: Phrase("package.changing", "Changing and teaching this plant"),
    PROOFS: Phrase("package.reporting", "Reporting failures and provoking faults"),
}
Asked = Annotated[str, Query(alias="words", max_length=100)]
Most = Annotated[int, Query(ge=1, le=200)]


def mount(
    server: FastAPI,
    plant: PageApi,
    pieces: Pieces | None = None,
    seen: Callable[[], Iterable[Seen]] = tuple,
) -> None:
    """Put the page at `/` of this app; StartError where this process shows a page already. `pieces`
    calls what is of packages, in the server's event loop, too. `seen` gives what the plant
    did before."""
    added = AddedParts(pieces, OWN)
    feed, show = Feed(plant, added.face, seen), Show(plant)
    shown: dict[tuple[object, ...], tuple[Layout, str]] = {}

    def made(layout: Layout, language: str, role: str | None) -> str:
        """The HTML of the parts, made anew once a version has changed what the plant is, or a piece of a
        package was left out."""
        of = (language, role, added.left_out)
        if of not in shown or shown[of][0] is not layout:
            shown[of] = (layout, drawn(added, plant, layout, words(language), role))
        return shown[of][1]

    def build(request: Request, client: Client) -> str:
        other = added.page(request, client, plant)
        if other is not None:
            return other
        wording, layout = words(language_of(request)), plant.layout()
        window.open_window(client, show)
        open_page(client, Desk(client, plant, feed, wording, added.acts), feed)
        html = made(layout, wording.language, role_shown(request))
        shell.fill(layout, wording, script=own("page.js"), added=added.assets, asks=added.asks(wording))
        return html

    window.serve(server, window.Scene(plant, show))
    _serve_tasks(server, plant, feed)
    added.serve(server, plant)
    shell.serve(server, plant.layout(), build, added.assets)
    _keep_running(feed, show)


def drawn(added: AddedParts, plant: PageApi, layout: Layout, wording: Words, role: str | None) -> str:
    """The HTML of the page for a role, without a package that breaks."""
    layout = {**layout, "recorded": layout.get("recorded", False) and PAST in added.pages}
    drawing = added.drawing(plant, layout, wording, role)
    wording = wording.also(drawing.labels)
    parts = all_parts(drawing.parts, role, drawing.put)

    def top(places: Places) -> None:
        header.build(layout, wording, places)
        header.told()
        drawing.put(Place.TOP)

    def foot() -> None:
        menu.build(layout, wording, drawing.put)

    try:
        return body(layout, wording, parts, header=top, footer=foot, within=WITHIN | drawing.within)
    except LeftOut:
        return drawn(added, plant, layout, wording, role)


def all_parts(added: Parts, role: str | None, put: Put) -> Parts:
    """The parts in their order."""

    def last(_layout: Layout, wording: Words) -> None:
        settings.build(wording, role, put)
        _say_missing(wording)

    return {
        "cells": partial(trees.build, put=put),
        "tasks": partial(tasks.build, put=put),
        **added,
        "events": timeline.build,
        "links": links.build,
        "settings": last,
    }


def _say_missing(words: Words) -> None:
    """Draw a line on the packages that are missing; nothing where all are there."""
    there = installed()
    said = [
        words.say(MISSING(what=what(), package=package))
        for package, what in WHAT.items()
        if package not in there
    ]
    if said:
        tag("p", ". ".join(said), classes="hint")


def _serve_tasks(server: FastAPI, plant: PageApi, feed: Feed) -> None:
    """Serve what is sent on demand only: the tree of a task that has ended, and the tasks of past starts."""

    async def one_task(request: Request, id: str) -> JSONResponse:
        found = await run_in_threadpool(plant.history, TaskQuery(id=id, limit=1)) if id else []
        return JSONResponse(feed.task_face(id, language_of(request), found[0] if found else None))

    async def kept(
        request: Request, words_: Asked = "", before: int | None = None, limit: Most = 20
    ) -> JSONResponse:
        query = TaskQuery(words=words_, before=before, limit=limit)
        rows = await run_in_threadpool(plant.history, query)
        return JSONResponse(history.face(rows, words(language_of(request)), time.time()))

    server.add_api_route(TASK, one_task, include_in_schema=False)
    server.add_api_route(HISTORY, kept, include_in_schema=False)


def open_page(client: Client, desk: Desk, feed: Feed) -> None:
    """Connect the page of one browser with the plant as long as it is open."""
    ui.on("arboleda", desk.hear)
    client.on_connect(lambda: feed.add(desk))
    client.on_delete(lambda: feed.remove(desk))


def _keep_running(feed: Feed, show: Show) -> None:
    background = Background(feed.run, show.run)

    async def start() -> None:
        feed.start()
        background.start()

    async def stop() -> None:
        feed.stop()
        await background.stop()

    app.on_startup(start)
    app.on_shutdown(stop)
