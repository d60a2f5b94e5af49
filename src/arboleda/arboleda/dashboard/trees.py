"""The cells: a card for each, its tree beside it, and the last changes of its tree."""

from __future__ import annotations

from typing import Any

from arboleda.views.view import devices_once

from . import ready
from .page_api import Layout
from .page_part import Place, Put, put_nothing
from .tags import link, live, rows, tag, way
from .wording import Words

FEW, CROWD = 4, 6  # cells: so few have all their trees on a wall screen, a crowd has small cards


def build(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    once = [*devices_once(layout["cells"])]
    rows("for_all", [""], classes="for-all")
    with tag("div", classes=f"cells {_size(len(layout['cells']))}"):
        for cell in layout["cells"]:
            with tag("article", classes="cell", data_cell=cell["name"]):
                _card(cell, [device for of, device in once if of == cell["name"]], words)
                put(Place.CARD, cell["name"])
                tree_box(cell, words, put)
                with tag("div", classes="changes"):
                    tag("h2", words("cells.changes", cell=cell["name"]))
                    if layout.get("recorded"):
                        there = {"tab": "cells", "cell": cell["name"], "task": None, "at": "failure"}
                        failure = f"{cell['name']}.failure"  # empty where none is in the record
                        way(None, there, classes="to-record", data_live=failure)
                    rows(f"changes.{cell['name']}", ["", "", ""], classes="small")


def _size(cells: int) -> str:
    if cells >= CROWD:
        return "crowd"
    return "few" if cells <= FEW else "many"


def beside(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    """Draw the tree of the chosen cell beside another view of that cell."""
    for cell in layout["cells"]:
        name = cell["name"]
        with tag("article", classes="box beside", data_cell=name):
            with tag("div", classes="card-head"):
                tag("h2", name)
                live("span", f"{name}.state", classes="pill")
            live("p", f"{name}.task", classes="task")
            tree_box(cell, words, put)


def _card(layout: dict[str, Any], devices: list[dict[str, Any]], words: Words) -> None:
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
    ready.build(cell, words)
    if layout["places"] or layout["stations"]:
        columns = [words(f"column.{each}") for each in ("place", "parts", "note", "acts")]
        rows(f"places.{cell}", columns, classes="places")
    if any(device["position"] is None for device in devices):
        rows(f"devices.{cell}", ["", "", ""], classes="devices")
        answers_table(f"heard.{cell}", words)


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
