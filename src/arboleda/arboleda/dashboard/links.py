"""The links: broker, ROS 2, and a row per robot."""

from __future__ import annotations

from . import panel
from .cell_filter import cell_filter
from .page_api import Layout
from .tags import live, rows, tag
from .wording import Words

COLUMNS = ("robot", "kind", "presence", "telemetry", "ready", "homed", "facts", "command", "refused")


def build(layout: Layout, words: Words) -> None:
    with tag("div", classes="box"):
        tag("h2", words("tab.links"))
        with tag("div", classes="facts"):
            for key in ("broker", "ros", "standbys", "memory", "strays"):
                live("p", key, classes="fact")
        cell_filter("links", layout, words)
        rows("links", [words(f"column.{name}") for name in COLUMNS], classes="links")


def of_record(layout: Layout, words: Words) -> None:
    """Draw the links of a record with its zones, which otherwise stand in the menu of the plant."""
    build(layout, words)
    panel.zones(words)
