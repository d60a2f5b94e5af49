"""The page: header with the big stop, the parts below it, and its mounting on the server's app."""

from __future__ import annotations

import asyncio
import hashlib
import json
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib import resources
from typing import Annotated

from fastapi import FastAPI, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from nicegui import Client, app, ui

from arboleda.adapters.oee_rows import OeeQuery
from arboleda.adapters.task_rows import TaskQuery
from arboleda.adapters.web.api import refuse
from arboleda.model.errors import StartError

from . import header, links, panel, tasks, timeline, trees
from .desk import Desk
from .faces import history, oee
from .feed import Feed
from .plant_side import Layout, PlantSide
from .tags import tag
from .twin import pane, window
from .twin.show import Show
from .unopened import Unopened
from .wording import LANGUAGES, Words, words

RECONNECT_S = 30.0
LANGUAGE_COOKIE = "arboleda_language"
PARTS: dict[str, Callable[[Layout, Words], None]] = {
    "cells": trees.build,
    "twin": pane.build,
    "tasks": tasks.build,
    "panel": panel.build,
    "links": links.build,
    "events": timeline.build,
}
Asked = Annotated[str, Query(alias="words", max_length=100)]
Hours = Annotated[float, Query(gt=0, le=1000)]
Most = Annotated[int, Query(ge=1, le=200)]
_here: list[FastAPI] = []


def mount(server: FastAPI, plant: PlantSide) -> None:
    """Put the page at `/` of this app; StartError where this process shows a page already."""
    if _here:
        raise StartError(
            "This process shows the page of another plant already; NiceGUI has one page a process."
        )
    _here.append(server)
    feed, show, unopened = Feed(plant), Show(plant), Unopened()
    _keep_running(feed, show)
    window.serve(server, plant, show)
    layout = plant.layout()
    _serve_tasks(server, plant, feed)
    app.add_static_files(assets(), str(resources.files(__package__).joinpath("assets")), max_cache_age=3600)

    @ui.page("/", title=f"{layout['plant']} · Arboleda")
    def page(request: Request, client: Client) -> None:
        unopened.add(client)
        window.open_window(client, show)
        said = words(language_of(request))
        desk = Desk(client, plant, feed, said)
        open_page(client, desk, feed, layout, said, role_shown(request))

    app.add_exception_handler(404, refuse)  # NiceGUI makes a page for each address that is not there
    app.add_exception_handler(405, refuse)
    ui.run_with(
        server,
        title="Arboleda",
        dark=None,
        tailwind=False,
        binding_refresh_interval=None,
        reconnect_timeout=RECONNECT_S,
        show_welcome_message=False,
        favicon=str(resources.files(__package__).joinpath("assets", "tree.svg")),
    )


def _serve_tasks(server: FastAPI, plant: PlantSide, feed: Feed) -> None:
    """What is sent on demand only: the tree of a task that has ended, and the tasks of earlier starts."""

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


def language_of(request: Request) -> str:
    """That of the address, else the one chosen before, else the first of the browser's that we have."""
    spoken = [each.strip()[:2].lower() for each in request.headers.get("accept-language", "").split(",")]
    asked = [request.query_params.get("lang"), request.cookies.get(LANGUAGE_COOKIE), *spoken]
    return next((each for each in asked if each in LANGUAGES), LANGUAGES[0])


def role_shown(request: Request) -> str | None:
    """The role somebody logged in with; None where nobody needs to log in."""
    door = request.scope.get("arboleda.door")
    return None if door is None or door.open else request.scope["arboleda.role"].value


def open_page(client: Client, desk: Desk, feed: Feed, layout: Layout, said: Words, role: str | None) -> None:
    """Build the page of one browser and let it live."""
    ui.add_head_html(head(said))
    ui.on("arboleda", desk.hear)
    client.on_connect(lambda: feed.add(desk))
    client.on_delete(lambda: feed.remove(desk))
    parts = parts_of(layout)
    with tag("div", classes="app"):
        header.build(layout, said, list(parts), role)
        with tag("div", id="parts"):
            for name, build in parts.items():
                label = said(f"tab.{name}")
                with tag("section", id=f"part-{name}", classes="part", data_part=name, aria_label=label):
                    build(layout, said)
        trees.detail(said)


def parts_of(layout: Layout) -> dict[str, Callable[[Layout, Words], None]]:
    """The parts that this plant has something to show in: there is no twin where no robot is drawn."""
    return {name: build for name, build in PARTS.items() if name != "twin" or layout["places"]["robots"]}


def head(said: Words) -> str:
    """What the page's head needs: our style, our script, and the few words that the script says itself."""
    spoken = {key[3:]: text for key, text in said.flat.items() if key.startswith("js.")}
    data = json.dumps({"language": said.language, "words": spoken}).replace("<", "\\u003c")
    return (
        f'<link rel="stylesheet" href="{assets()}/page.css">'
        f'<link rel="stylesheet" href="{assets()}/twin.css">'
        f"<script>window.arboledaPage = {data};</script>"
        f'<script type="module" src="{assets()}/page.js"></script>'
        f'<script type="module" src="{assets()}/twin.js"></script>'
    )


@cache
def assets() -> str:
    """Where our files are served: another place when one of them has changed, as browsers keep them."""
    files = sorted(resources.files(__package__).joinpath("assets").iterdir(), key=lambda file: file.name)
    return f"/arboleda/{hashlib.sha256(b''.join(file.read_bytes() for file in files)).hexdigest()[:12]}"


def _keep_running(feed: Feed, show: Show) -> None:
    running: list[asyncio.Task[None]] = []

    async def start() -> None:
        feed.start()
        running.extend(asyncio.create_task(each.run()) for each in (feed, show))

    async def stop() -> None:
        feed.stop()
        for task in running:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task

    app.on_startup(start)
    app.on_shutdown(stop)
