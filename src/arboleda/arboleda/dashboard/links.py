"""The links: broker, ROS 2, and a row per robot."""

from __future__ import annotations

from . import panel
from .cell_filter import cell_filter
from .page_api import Layout
from .page_part import Place, Put, put_nothing
from .tags import live, rows, tag
from .wording import Words

COLUMNS = ("robot", "kind", "presence", "telemetry", "ready", "homed", "facts", "command", "refused")


def build(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    with tag("div", classes="box"):
        tag("h2", words("tab.links"))
        with tag("div", classes="facts"):
            for key in ("broker", "ros", "standbys", "memory", "strays"):
                live("p", key, classes="fact")
        cell_filter("links", layout, words)
        rows("links", [words(f"column.{name}") for name in COLUMNS], classes="links")
    put(Place.LINKS)


def of_record(layout: Layout, words: Words) -> None:
    """Draw the links of a record with its zones, which otherwise stand beside the operator's verbs."""
    build(layout, words)
    panel.zones(words)
