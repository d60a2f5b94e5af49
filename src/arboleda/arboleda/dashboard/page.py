"""The page of a plant that runs: header with the big stop, the parts below it, and its mounting."""

from __future__ import annotations

import time
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

from fastapi import FastAPI, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse, Response

from arboleda.model.packages import FLEET
from arboleda.store.task_rows import TaskQuery
from arboleda.web.access.auth import Role
from arboleda.web.desks.make import MakeApi
from arboleda.web.desks.oee import OeeApi, OeeQuery
from arboleda.web.desks.versions import VersionsApi
from arboleda.web.missing import missing

from . import (
    demo,
    fault_form,
    findings_route,
    header,
    links,
    make,
    panel,
    proof,
    reports,
    shell,
    tasks,
    teach_panel,
    timeline,
    tree_editor,
    trees,
)
from .body import Parts, body
from .desk import Desk
from .faces import history, oee, versions
from .feed import Feed
from .frames import Background
from .page_api import Layout, PageApi
from .past import page as past_page
from .past.frame_queue import BESIDE_S, FrameQueue
from .past.side import PastSide
from .past.stills import Stills
from .shell import is_operator, language_of, role_shown
from .toolkit import Client, app, ui
from .twin import pane, window
from .twin.show import Show
from .wording import words

if TYPE_CHECKING:
    from .past.tried import TriedPlants

PARTS: Parts = {
    "cells": trees.build,
    "twin": pane.build,
    "tasks": tasks.build,
    "panel": panel.build,
    "teach": teach_panel.build,
    "make": make.build,
    "draw": tree_editor.build,
    "links": links.with_versions,
    "events": timeline.build,
}
FROM_CARDS = ("teach",)
"""Parts that no tab of the header leads to, but the card of a cell."""
OF_OPERATORS = ("make", "teach")
Asked = Annotated[str, Query(alias="words", max_length=100)]
Hours = Annotated[float, Query(gt=0, le=1000)]
Most = Annotated[int, Query(ge=1, le=200)]


def mount(server: FastAPI, plant: PageApi) -> None:
    """Put the page at `/` of this app; StartError where this process shows a page already."""
    feed, show = Feed(plant), Show(plant)
    stills, turns = Stills(), FrameQueue(BESIDE_S)
    tried = Tried(plant)
    shown: dict[tuple[str, str | None], tuple[Layout, str]] = {}

    def made(layout: Layout, language: str, role: str | None) -> str:
        """The HTML, made anew once a version has changed what the plant is."""
        known = shown.get((language, role))
        if known is None or known[0] is not layout:
            known = shown[language, role] = layout, drawn(layout, language, role)
        return known[1]

    def drawn(layout: Layout, language: str, role: str | None) -> str:
        wording, parts = words(language), parts_for(role)

        def top(names: list[str]) -> None:
            header.build(layout, wording, [name for name in names if name not in FROM_CARDS], role)
            if layout.get("demo"):
                demo.build(wording)
            if role != Role.VIEWER.value:
                fault_form.drawer(layout, wording)

        return body(layout, wording, parts, header=top)

    def build(request: Request, client: Client) -> None:
        if past_page.is_of_draft(request) and is_operator(request):
            past_page.open_page(client, *tried.last(), turns, request, beside=True)
            return
        if past_page.is_of_record(request):
            past_page.open_page(client, plant, stills, turns, request, beside=True)
            return
        wording, layout = words(language_of(request)), plant.layout()
        window.open_window(client, show)
        open_page(client, Desk(client, plant, feed, wording), feed)
        html = made(layout, wording.language, role_shown(request))
        shell.fill(layout, wording, PARTS, script="page.js", made=html)

    window.serve(server, plant, show, stills, tried=tried.last)
    _serve_tasks(server, plant, feed)
    reports.serve(server, plant)
    proof.serve(server, plant)
    findings_route.serve(server, plant)
    shell.serve(server, plant.layout(), build)
    _keep_running(feed, show)


def parts_for(role: str | None) -> Parts:
    """The parts of the page of a role: only operators make or teach something."""
    return {
        name: part
        for name, part in PARTS.items()
        if name not in OF_OPERATORS or role in (None, Role.OPERATOR.value)
    }


class Tried:
    """Tried: the last tryout of the draft, with the twin of its own at moments of it."""

    def __init__(self, plant: PageApi) -> None:
        self._plant = plant
        self._known: tuple[PastSide, Stills] | None = None

    def last(self) -> tuple[PastSide, Stills]:
        """The tryout and its drawings; an ArboledaError says that there is none."""
        desk = self._plant.ask(MakeApi)
        side = self._plants.last(None if desk is None else desk.tried())
        if self._known is None or self._known[0] is not side:
            self._known = side, Stills()
        return self._known

    @cached_property
    def _plants(self) -> TriedPlants:
        from .past.tried import TriedPlants  # slow to load, and only needed for a record

        return TriedPlants()


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

    async def figures(request: Request, hours: Hours = 24.0) -> JSONResponse:
        query = OeeQuery(since_s=time.time() - hours * 3600)
        desk = plant.ask(OeeApi)
        if desk is None:
            raise missing(FLEET)
        rows = await run_in_threadpool(desk.oee, query)
        return JSONResponse(oee.face(rows, words(language_of(request))))

    async def versions_kept(request: Request) -> Response:
        desk = plant.ask(VersionsApi)
        listed = None if desk is None else await run_in_threadpool(desk.listed)
        if listed is None:
            return Response(status_code=404)
        return JSONResponse(versions.face(listed, words(language_of(request))))

    server.add_api_route("/versions.json", versions_kept, include_in_schema=False)
    server.add_api_route("/oee.json", figures, include_in_schema=False)
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
