"""The cells: a card for each, and of the chosen one its tree, the last changes of that, and the twin."""

from __future__ import annotations

from typing import Any

from arboleda.views.view import devices_once

from . import menu
from .page_api import Layout
from .page_part import Place, Put, put_nothing
from .tags import link, live, rows, tag, way
from .wording import Words

CROWD = 6  # cells, of which each has a small card; of fewer all have their trees on a wall screen
TWIN_TOOLS = {"reset": "⌂", "top": "▦", "in": "+", "out": "−"}  # noqa: RUF001 - a minus sign
TWIN_KINDS = ("measured", "estimated", "stale", "unknown", "goal", "part")


def build(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    once = [*devices_once(layout["cells"])]
    with tag("div", classes="desk"):
        with tag("div", classes=f"cells {_size(len(layout['cells']))}"):
            for cell in layout["cells"]:
                with tag("article", classes="cell", data_cell=cell["name"]):
                    _card(cell, [device for of, device in once if of == cell["name"]], words, put)
                    tree_box(cell, words, put)
                    _changes(layout, cell["name"], words)
        if layout["places"]["robots"]:
            _twin(layout, words)


def _changes(layout: Layout, cell: str, words: Words) -> None:
    title = words("cells.changes", cell=cell)
    with tag("div", classes="changes", role="group", tabindex="0", aria_label=title):
        tag("h2", title)
        if layout.get("recorded"):
            there = {"tab": "cells", "cell": cell, "task": None, "at": "failure"}
            way(None, there, classes="to-record", data_live=f"{cell}.failure")  # empty where there is none
        rows(f"changes.{cell}", ["", "", ""], classes="small")


def _size(cells: int) -> str:
    return "crowd" if cells >= CROWD else "few"


def _card(layout: dict[str, Any], devices: list[dict[str, Any]], words: Words, put: Put) -> None:
    """Draw the card of a cell; `devices` are those shown on it: a shared one is shown with its first cell."""
    cell = layout["name"]
    with tag(
        "button", type="button", classes="card", data_choose=cell, title=words("cells.choose", cell=cell)
    ):
        with tag("span", classes="card-head"):
            tag("span", cell, classes="cell-name")
            live("span", f"{cell}.state", classes="pill")
        live("span", f"{cell}.task", classes="task")
        live("span", f"{cell}.step", classes="step")
        with tag("span", classes="meter"):
            tag("span", data_bar=f"{cell}.progress", classes="bar")
        with tag("span", classes="times"):
            live("span", f"{cell}.elapsed")
            live("span", f"{cell}.left")
            live("span", f"{cell}.queue")
        live("span", f"{cell}.cause", classes="trouble")
        live("span", f"{cell}.trouble", classes="trouble")
        live("span", f"{cell}.act", classes="act-line")
    for device in devices:
        if device["asked"]:
            _question(device["name"])
    _ready(cell, words)
    if layout["places"] or layout["stations"]:
        rows(f"places.{cell}", ["", ""], classes="places")
    if any(device["position"] is None for device in devices):
        rows(f"devices.{cell}", ["", "", ""], classes="devices")
        answers_table(f"heard.{cell}", words)
    with tag("div", classes="card-acts"):
        menu.opener(cell, words("panel.title"), words("menu.open", cell=cell))
        put(Place.CARD, cell)


def _question(person: str) -> None:
    """Draw the question to a person, announced once; the time that is left is not announced."""
    with tag("div", classes="asked"):
        with tag("div", role="status", aria_live="polite"):
            live("p", f"asked_who.{person}", classes="asked-who")
            live("p", f"asked.{person}", classes="asked-question")
        rows(f"answers.{person}", [""], classes="answers small")
        live("p", f"asked_left.{person}", classes="asked-left")


def answers_table(name: str, words: Words) -> None:
    """Draw the table of answers to a task: the one who answered, the question and the answer."""
    rows(name, [words(f"column.{each}") for each in ("by", "question", "answer")], classes="heard")


def tree_box(layout: dict[str, Any], words: Words, put: Put) -> None:
    """Draw the box of a cell's tree; the offers of an idle cell stand above it."""
    cell = layout["name"]
    with tag("div", classes="tree-box"):
        tag("h2", words("cells.tree", cell=cell))
        with tag("div", classes="tree-tools"):
            live("span", f"{cell}.feedback", classes="feedback")
            _offer(cell, classes="act offer")
            put(Place.TREE, cell)
            zooms(words)
        with tag("div", classes="empty"):
            tag("p", words("cells.no_tree"))
            for recipe in layout["recipes"][:1]:
                welcome = words("cells.welcome", text=recipe["example"], form=recipe["form"])
                tag("p", welcome, classes="example")
            _offer(cell, classes="act primary offer")
            put(Place.TREE, cell)
        tag("div", classes="tree", data_tree=cell, role="tree", aria_label=words("cells.tree", cell=cell))


def _offer(cell: str, classes: str) -> None:
    link(None, tab="tasks", cell=cell, classes=classes, data_live=f"{cell}.offer")


def zooms(words: Words) -> None:
    """Draw the tools of the tree in the same box."""
    for name, sign in {"smaller": "−", "larger": "+", "fit": "⤢"}.items():  # noqa: RUF001 - a minus sign
        label = words(f"cells.{name}")
        tag("button", sign, type="button", classes="tool", data_zoom=name, title=label, aria_label=label)


def detail(words: Words) -> None:
    """Draw the box of details that a click on a node opens; the script fills it."""
    with tag("aside", id="node", hidden="true", aria_live="polite", aria_label=words("node.title")):
        tag("button", "×", type="button", id="node-close", classes="tool", aria_label=words("node.close"))  # noqa: RUF001
        tag("h2", id="node-name")
        tag("p", id="node-state", classes="pill")
        tag("p", id="node-about")
        tag("p", id="node-times")
        tag("p", id="node-feedback")
        tag("p", id="node-failure", classes="trouble", data_label=words("node.failure"))
        tag("dl", id="node-given")


def _ready(cell: str, words: Words) -> None:
    """Draw the button of a cell, and the list of its advice."""
    rows(f"ready.{cell}", ["", ""], classes="ways")
    with tag("details", classes="more"):
        tag("summary", words("ready.more"))
        rows(f"ways.{cell}", ["", ""], classes="ways")


def _twin(layout: Layout, words: Words) -> None:
    """Draw the box that the script of the twin draws into, and the controls beside it."""
    with tag("div", classes="box twin"):
        with tag("div", classes="box-head"):
            tag("h2", words("js.twin_plant"), id="twin-title")
            _twin_tools(words)
        with tag("div", id="twin", classes="twin-view"):
            tag("p", words("twin.loading"), id="twin-note", role="status", data_flat=words("twin.flat"))
        tag("ul", id="twin-robots", classes="twin-robots", aria_label=words("twin.robots"))
        with tag("details", classes="twin-how"):
            tag("summary", words("twin.legend"))
            _twin_legend(layout, words)


def _twin_tools(words: Words) -> None:
    with tag("div", classes="twin-tools"):
        for name, sign in TWIN_TOOLS.items():
            does = words(f"twin.{name}")
            tag("button", sign, type="button", classes="tool", data_twin=name, title=does, aria_label=does)


def _twin_legend(layout: Layout, words: Words) -> None:
    kinds = [*TWIN_KINDS, *(("held", "quarantined") if layout["zones"] else ())]
    with tag("ul", classes="twin-legend", aria_label=words("twin.legend")):
        for kind in kinds:
            with tag("li", title=words(f"twin.about_{kind}")):
                tag("span", classes=f"swatch {kind}")
                tag("span", words(f"twin.{kind}"))
