"""The page on a record: the parts of the page that only show, and the bar of the record below them."""

from __future__ import annotations

import re

from fastapi import FastAPI, Request

from .. import header, links, shell, tasks, timeline, told, trees
from ..asset_files import own
from ..body import Parts, Places, body
from ..toolkit import Client, ui
from ..twin import window
from ..wording import words
from . import bar
from .frame_queue import FrameQueue
from .side import PastSide
from .stills import Stills
from .visitor import Arrival, Visitor

KEY, OF_TASK, START = "at", "task", "record"  # keys of the page's address
EPOCH = re.compile(r"[0-9]{1,10}", re.ASCII)
PARTS: Parts = {
    "cells": trees.build,
    "tasks": tasks.of_record,
    "events": timeline.of_record,
    "links": links.of_record,
}


def is_of_record(request: Request) -> bool:
    """True if the address is one of a record."""
    return KEY in request.query_params


def record_named(request: Request) -> str:
    """The name of the record that the address names in the place of a start, "" for none."""
    return request.query_params.get(START, "") if is_of_record(request) else ""


def mount(server: FastAPI, side: PastSide) -> None:
    """Put the page on a record at `/` of this app, which serves no running plant; StartError if this process
    shows a page already."""
    stills, turns = Stills(), FrameQueue()

    def build(request: Request, client: Client) -> str:
        return open_page(client, side, stills, turns, request)

    window.serve(server, side, stills)
    shell.serve(server, side.layout(), build)


def open_page(
    client: Client,
    side: PastSide,
    stills: Stills,
    turns: FrameQueue,
    request: Request,
    *,
    beside: bool = False,
) -> str:
    """Build the page of one browser on a record, and return the HTML of its parts; `beside` a plant that runs
    it has a link to that."""
    layout, wording = {**side.layout(), "recorded": False}, words(shell.language_of(request))
    visitor = Visitor(client, side, stills, turns, wording, arrival(request))
    ui.on("arboleda-past", visitor.hear)
    ui.on(window.EVENT, visitor.hear)
    window.bring_three()
    client.on_connect(visitor.come)
    role = shell.role_shown(request)
    shell.fill(layout, wording, script=own("record.js"))

    def top(places: Places) -> None:
        header.of_record(layout, wording, places, role, beside=beside)
        told.build()

    return body(
        layout,
        wording,
        PARTS,
        header=top,
        footer=lambda: bar.build(layout, wording),
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
