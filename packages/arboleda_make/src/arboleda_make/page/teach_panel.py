"""The panel of who teaches a cell: who it is, and what moves each device; the script fills the latter."""

from __future__ import annotations

from typing import Any

from arboleda.dashboard.tags import link, way
from arboleda.extension import Face, Layout, Moment, Spot, Words, live, tag
from arboleda.views.view import standing
from arboleda_make.trying.api import MakeApi

STEPS = ("hold", "10", "1", "0.1")  # what a button of an axis does: on and on, or so many degrees or mm
LONGEST_NAME = 40


def build(spot: Spot) -> None:
    words = spot.words
    with tag("div", id="teach", classes="teach"):
        with tag("div", classes="box"):
            tag("h2", words("teach.title"))
            _who(spot.layout, words)
            for cell in spot.layout["cells"]:
                name = cell["name"]
                live("p", f"{name}.taught", classes="hint teach-state", data_teach_cell=name, hidden="true")
            tag("p", words("teach.not_safety"), classes="hint")
        _steps(words)
        tag("div", id="teach-devices", classes="teach-devices")
        if spot.plant.ask(MakeApi) is not None:
            way(words("teach.recipe"), {"tab": "make"}, id="teach-recipe", classes="act")
        tag("p", id="teach-note", role="status", classes="act-note")


def _who(layout: Layout, words: Words) -> None:
    with tag("div", classes="teach-bar"):
        with tag("label", words("teach.cell")), tag("select", id="teach-cell"):
            for cell in layout["cells"]:
                tag("option", cell["name"], value=cell["name"])
        with tag("label", words("teach.name")):
            longest = str(LONGEST_NAME)
            tag("input", id="teach-name", type="text", maxlength=longest, autocomplete="name")
        tag("button", words("verb.teach"), type="button", id="teach-begin", classes="act primary")
        tag("button", words("verb.automatic"), type="button", id="teach-end", classes="act")


def _steps(words: Words) -> None:
    with tag("div", classes="scopes teach-steps", role="group", aria_label=words("teach.step")):
        for each in STEPS:
            pressed = "true" if each == STEPS[0] else "false"
            label = words("teach.hold") if each == STEPS[0] else each
            tag("button", label, type="button", classes="choice", data_step=each, aria_pressed=pressed)
    tag("p", words("teach.keys"), classes="hint")


def way_from_tree(spot: Spot) -> None:
    """Draw the link from the tree of a cell to its teaching."""
    link(spot.words("teach.open"), tab="teach", cell=spot.cell, classes="act to-teach")


def face(moment: Moment) -> Face:
    """The person who teaches each cell."""
    return {
        f"text/{cell['name']}.taught": [_taught(moment.words, cell), standing(cell)]
        for cell in moment.snapshot["cells"]
    }


def _taught(words: Words, cell: dict[str, Any]) -> str:
    teaching = cell["teaching"]
    return words("teach.by", teacher=teaching["teacher"]) if teaching else ""
