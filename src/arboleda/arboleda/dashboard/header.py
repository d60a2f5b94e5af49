"""The header: which plant this is, how it stands, and the stop that is always there."""

from __future__ import annotations

from typing import Any

from . import menu, tools
from .body import Places
from .page_api import Layout
from .tags import link, live, rows, tag, way
from .wording import Words

OF_PLANT: dict[str, Any] = {"title": "", "leave": "record.leave", "back": {}}


def build(layout: Layout, words: Words, places: Places) -> None:
    """Draw the header, with what can be asked of the whole plant."""
    with tag("header", classes="top"):
        _stop(words, words("stop.button"), words("does.stop"))
        with tag("div", classes="brand"):
            tag("h1", layout["plant"])
            rows("counts", [""], classes="counts")
            live("p", "sum", classes="sum", role="status")
        _tabs(words, places)
        menu.opener(menu.PLANT, words("panel.plant"), words("panel.plant"))
        rows("for_all", [""], classes="for-all")
        with tag("p", id="connection", role="status", data_lost=words("page.lost")):
            tag("span", words("page.connecting"), data_said="")
            tag("span", id="standbys")
        tag("div", id="answer", role="status", aria_live="polite")


def of_record(layout: Layout, words: Words, places: Places, role: str | None, *, beside: bool) -> None:
    """Draw the header of a record, which has no stop; `beside` a running plant it links back to that. A
    record that is none of the plant's own says in `layout["titles"]` what it is, and where it leads back to.
    """
    titles = layout.get("titles", OF_PLANT)
    with tag("header", classes="top"):
        with tag("div", classes="brand"):
            tag("h1", words(titles["title"], plant=layout["plant"]) if titles["title"] else layout["plant"])
            rows("counts", [""], classes="counts")
            live("p", "sum", classes="sum")
        _tabs(words, places)
        if beside:
            to = {"at": None, "task": None, "record": None, **titles["back"]}
            way(words(titles["leave"]), to, classes="act record-leave")
        tools.build(words, role)
        tag("p", words("record.reading"), id="connection", role="status", data_lost=words("record.lost"))
        tag("div", id="answer", role="status", aria_live="polite")


def of_site(words: Words, places: Places, role: str | None) -> None:
    """Draw the header of the page on many plants."""
    with tag("header", classes="top"):
        _stop(words, words("site.stop_all"), words("site.stop_all_does"))
        with tag("div", classes="brand"):
            tag("h1", words("site.title"))
            live("p", "sum", classes="sum", role="status")
        _tabs(words, places)
        tools.build(words, role)
        tag("p", words("page.connecting"), id="connection", role="status", data_lost=words("site.lost"))
        tag("div", id="answer", role="status", aria_live="polite")


def _stop(words: Words, label: str, does: str) -> None:
    """Draw the stop button, the first element that the keyboard reaches."""
    with tag("div", classes="stop"):
        tag("button", label, id="stop", type="button", title=does)
        live("p", "stop", classes="stop-state", role="status", aria_live="assertive")
        tag("p", words("stop.held_key"), classes="stop-key")


def _tabs(words: Words, places: Places) -> None:
    with tag("nav", classes="tabs", aria_label=words("page.parts")):
        for place, parts in places.items():
            there = {"data_tab": place, "data_parts": " ".join(parts)}
            link(words.of("tab", place), tab=parts[0], classes="tab", **there)


def told() -> None:
    """Draw the alarms of packages (the package, the cell, what it says), and what packages ask."""
    with tag("div", classes="told", role="status", aria_live="polite"):
        rows("alarms", ["", "", ""], classes="alarms")
        rows("asks", ["", ""], classes="asks")
