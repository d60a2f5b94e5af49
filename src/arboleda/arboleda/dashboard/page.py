"""The page of a plant that runs: header with the big stop, the parts below it, and its mounting."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import Annotated

from fastapi import FastAPI, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse

from arboleda.store.task_rows import TaskQuery

from . import header, links, missing_packages, panel, shell, tasks, timeline, trees
from .added import AddedParts, LeaveOut, LeftOut
from .asset_files import own
from .body import Parts, body
from .desk import Desk
from .faces import history
from .feed import Feed
from .frames import Background
from .page_api import Layout, PageApi, Seen
from .page_part import Place, Put
from .past import page as past_page
from .past.frame_queue import BESIDE_S, FrameQueue
from .past.other import LastOther
from .past.stills import Stills
from .shell import is_operator, language_of, role_shown
from .toolkit import Client, app, ui
from .twin import pane, window
from .twin.show import Show
from .wording import Words, words

OWN = ("cells", "twin", "tasks", "panel", "links", "events")
Asked = Annotated[str, Query(alias="words", max_length=100)]
Most = Annotated[int, Query(ge=1, le=200)]


def mount(
    server: FastAPI,
    plant: PageApi,
    leave_out: LeaveOut | None = None,
    seen: Callable[[], Iterable[Seen]] = tuple,
) -> None:
    """Put the page at `/` of this app; StartError where this process shows a page already. `leave_out` is
    told of a package that breaks, and is called in the server's event loop, too. `seen` gives what the plant
    did before."""
    added = AddedParts(leave_out)
    feed, show = Feed(plant, added.face, seen), Show(plant)
    stills, turns = Stills(), FrameQueue(BESIDE_S)
    others = {name: LastOther(partial(each.side, plant)) for name, each in added.records.items()}
    shown: dict[tuple[object, ...], tuple[Layout, Parts, str]] = {}

    def made(layout: Layout, language: str, role: str | None) -> tuple[Parts, str]:
        """The parts and their HTML, made anew once a version has changed what the plant is, or a package was
        left out."""
        of = (language, role, *added.packages)
        if of not in shown or shown[of][0] is not layout:
            shown[of] = (layout, *drawn(added, plant, layout, words(language), role))
        return shown[of][1:]

    def build(request: Request, client: Client) -> str:
        if past_page.is_of_record(request):
            other = others.get(past_page.record_named(request)) if is_operator(request) else None
            side, drawings = (plant, stills) if other is None else other.last()
            return past_page.open_page(client, side, drawings, turns, request, beside=True)
        wording, layout = words(language_of(request)), plant.layout()
        window.open_window(client, show)
        open_page(client, Desk(client, plant, feed, wording, added.acts), feed)
        parts, html = made(layout, wording.language, role_shown(request))
        shell.fill(layout, wording, parts, script=own("page.js"), added=added.assets)
        return html

    scenes = {
        name: window.OtherScene(last=others[name].last, may=each.may) for name, each in added.records.items()
    }
    window.serve(server, plant, show, stills, others=scenes)
    _serve_tasks(server, plant, feed)
    added.serve(server, plant)
    shell.serve(server, plant.layout(), build, added.assets)
    _keep_running(feed, show)


def drawn(
    added: AddedParts, plant: PageApi, layout: Layout, wording: Words, role: str | None
) -> tuple[Parts, str]:
    """The parts of the page for a role, and their HTML; without a package that breaks."""
    drawing = added.drawing(plant, layout, wording, role)
    parts = all_parts(drawing.parts, drawing.put)

    def top(names: list[str]) -> None:
        header.build(layout, wording, [name for name in names if name not in drawing.without_tab], role)
        drawing.put(Place.TOP)

    try:
        return parts, body(layout, wording, parts, header=top)
    except LeftOut:
        return drawn(added, plant, layout, wording, role)


def all_parts(added: Parts, put: Put) -> Parts:
    """The parts in their order; no package takes the place of one of the runner's."""

    def last(layout: Layout, wording: Words) -> None:
        links.build(layout, wording, put)
        missing_packages.build(wording)

    return {
        "cells": partial(trees.build, put=put),
        "twin": partial(pane.build, put=put),
        "tasks": partial(tasks.build, put=put),
        "panel": panel.build,
        **{name: build for name, build in added.items() if name not in OWN},
        "links": last,
        "events": timeline.build,
    }


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

    server.add_api_route("/task.json", one_task, include_in_schema=False)
    server.add_api_route("/history.json", kept, include_in_schema=False)


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
