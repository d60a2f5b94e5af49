"""The page on a record: the parts of the page that only show, and the bar of the record below them."""

from __future__ import annotations

import re
from urllib.parse import urlencode

from fastapi import FastAPI, Request

from arboleda.dashboard import shell
from arboleda.dashboard.lone_page import record_page
from arboleda.dashboard.toolkit import Client, ui
from arboleda.dashboard.twin import window
from arboleda.extension import Assets, words

from . import bar
from .frame_queue import FrameQueue
from .side import PastSide, Shown
from .visitor import Arrival, Visitor

SCENE = "/past/scene.json"
ASSETS = Assets(package=__package__, styles=("record",))
KEY, OF_TASK, START = "at", "task", "record"  # keys of the page's address
EPOCH = re.compile(r"[0-9]{1,10}", re.ASCII)


def mount(server: FastAPI, side: PastSide) -> None:
    """Put the page on a record at `/` of this app, which serves no running plant; StartError if this process
    shows a page already."""
    shown, turns = Shown(side), FrameQueue()

    def build(request: Request, client: Client) -> str:
        return open_page(client, shown, turns, request)

    server.add_api_route(SCENE, shown.scene.answer, include_in_schema=False)
    shell.serve(server, side.layout(), build, [ASSETS])


def open_page(
    client: Client, shown: Shown, turns: FrameQueue, request: Request, *, of: str = "", beside: bool = False
) -> str:
    """Build the page of one browser on a record, and return the HTML of its parts; `beside` a plant that runs
    it has a link to that. `of` is the name of a record that is none of a start."""
    layout, wording = {**shown.side.layout(), "recorded": False}, words(shell.language_of(request))
    visitor = Visitor(client, shown, turns, wording, arrival(request))
    ui.on("arboleda-past", visitor.hear)
    ui.on(window.EVENT, visitor.hear)
    window.bring_three()
    client.on_connect(visitor.come)
    shell.fill(layout, wording, script=ASSETS.of("record.js"), added=[ASSETS])
    scene = f"{SCENE}?{urlencode({START: of})}" if of else SCENE
    return record_page(
        layout, wording, shell.role_shown(request), lambda: bar.build(layout, wording, scene), beside=beside
    )


def arrival(request: Request) -> Arrival:
    """The place in the record that the address names: `at=1795324375.912` is Unix time, `at=task` the end of
    the task that it names, anything else the last failure."""
    query = request.query_params
    moment_text = query.get(KEY, "")
    try:
        moment = round(float(moment_text) * 1000)
    except (OverflowError, ValueError):
        moment = None
    start = query.get(START, "")
    return Arrival(
        moment=moment,
        task=query.get("task"),
        at_its_end=moment_text == OF_TASK,
        cell=query.get("cell"),
        epoch=int(start) if EPOCH.fullmatch(start) else None,
    )
