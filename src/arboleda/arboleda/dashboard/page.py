"""The page of a plant that runs: header with the big stop, the parts below it, and its mounting."""

from __future__ import annotations

import time
from functools import cache
from typing import Annotated

from fastapi import FastAPI, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from nicegui import Client, app, ui

from arboleda.store.oee_rows import OeeQuery
from arboleda.store.task_rows import TaskQuery

from . import demo, header, links, panel, reports, shell, tasks, timeline, tree_editor, trees
from .desk import Desk
from .faces import history, oee
from .feed import Feed
from .frames import Background
from .page_api import PageApi
from .past import page as past_page
from .past.frame_queue import BESIDE_S, FrameQueue
from .past.stills import Stills
from .shell import Parts, language_of, role_shown
from .twin import pane, window
from .twin.show import Show
from .wording import words

PARTS: Parts = {
    "cells": trees.build,
    "twin": pane.build,
    "tasks": tasks.build,
    "panel": panel.build,
    "draw": tree_editor.build,
    "links": links.build,
    "events": timeline.build,
}
Asked = Annotated[str, Query(alias="words", max_length=100)]
Hours = Annotated[float, Query(gt=0, le=1000)]
Most = Annotated[int, Query(ge=1, le=200)]


def mount(server: FastAPI, plant: PageApi) -> None:
    """Put the page at `/` of this app; StartError where this process shows a page already."""
    feed, show = Feed(plant), Show(plant)
    stills, turns = Stills(), FrameQueue(BESIDE_S)
    layout = plant.layout()

    @cache
    def made(language: str, role: str | None) -> str:
        said = words(language)

        def top(parts: list[str]) -> None:
            header.build(layout, said, parts, role)
            if layout.get("demo"):
                demo.build(said)

        return shell.body(layout, said, PARTS, header=top)

    def build(request: Request, client: Client) -> None:
        if past_page.asked(request):
            past_page.open_page(client, plant, stills, turns, request, beside=True)
            return
        said = words(language_of(request))
        window.open_window(client, show)
        open_page(client, Desk(client, plant, feed, said), feed)
        shell.fill(layout, said, PARTS, script="page.js", made=made(said.language, role_shown(request)))

    window.serve(server, plant, show, stills)
    _serve_tasks(server, plant, feed)
    reports.serve(server, plant)
    shell.serve(server, layout, build)
    _keep_running(feed, show)


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
        rows = await run_in_threadpool(plant.oee, query)
        return JSONResponse(oee.face(rows, words(language_of(request))))

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
