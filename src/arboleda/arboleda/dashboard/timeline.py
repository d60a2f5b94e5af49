"""The time line: the events, the newest first, for one cell or all, and as a file."""

from __future__ import annotations

from .cell_filter import cell_filter
from .page_api import Layout
from .tags import act_button, rows, tag
from .wording import Words

COLUMNS = ("at", "cell", "event", "sentence")


def build(layout: Layout, words: Words) -> None:
    with tag("div", classes="box"):
        with tag("div", classes="box-head"):
            _head(layout, words)
            act_button(words("events.download"), "download", "", words("events.download_does"))
        _rows(words)


def of_record(layout: Layout, words: Words) -> None:
    """Draw the time line of a record, up to the moment that is shown."""
    with tag("div", classes="box"):
        with tag("div", classes="box-head"):
            _head(layout, words)
        _rows(words)


def _head(layout: Layout, words: Words) -> None:
    tag("h2", words("tab.events"))
    cell_filter("events", layout, words)


def _rows(words: Words) -> None:
    columns = [words(f"column.{name}") for name in COLUMNS]
    rows("events", columns, empty=words("events.none"), classes="events")
