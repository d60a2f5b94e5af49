"""Pages of a plant that answers nobody: of one that has no server, and of a record."""

from __future__ import annotations

from collections.abc import Callable

from . import header, links, menu, settings, tasks, timeline, trees
from .body import Parts, Places, body
from .page_api import Layout
from .wording import Words

PARTS: Parts = {
    "cells": trees.build,
    "tasks": tasks.of_start,
    "events": timeline.of_record,
    "links": links.build,
    "settings": lambda _, words: settings.build(words, None),
}
OF_RECORD: Parts = {
    "cells": trees.build,
    "tasks": tasks.of_record,
    "events": timeline.of_record,
    "links": links.of_record,
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


def record_page(
    layout: Layout, wording: Words, role: str | None, below: Callable[[], None], *, beside: bool
) -> str:
    """The HTML of the page on a record, for this role; `beside` a plant that runs it has a link to that."""

    def top(places: Places) -> None:
        header.of_record(layout, wording, places, role, beside=beside)
        header.told()

    return body(layout, wording, OF_RECORD, header=top, footer=below)
