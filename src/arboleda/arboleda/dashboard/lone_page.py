"""The page of a plant that has no server, such as one that runs in a browser."""

from __future__ import annotations

from collections.abc import Callable

from . import header, links, menu, settings, tasks, timeline, trees
from .body import Parts, body
from .page_api import Layout
from .wording import Words

PARTS: Parts = {
    "cells": trees.build,
    "tasks": tasks.of_start,
    "events": timeline.of_record,
    "links": links.build,
    "settings": lambda _, words: settings.build(words, None),
}


def lone_page(layout: Layout, wording: Words, below: Callable[[], None]) -> str:
    """The HTML of the page; `below` draws what stands below its parts."""

    def footer() -> None:
        menu.build(layout, wording)
        below()

    return body(
        layout,
        wording,
        PARTS,
        header=lambda places: header.build(layout, wording, places),
        footer=footer,
    )
