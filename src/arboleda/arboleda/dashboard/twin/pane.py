"""The twin's pane on the page: the box that the script draws into, and the controls beside it."""

from __future__ import annotations

from ..page_api import Layout
from ..page_part import Put, put_nothing
from ..tags import tag
from ..trees import beside
from ..wording import Words

TOOLS = {"reset": "⌂", "top": "▦", "in": "+", "out": "−"}  # noqa: RUF001 - a minus sign
KINDS = ("measured", "estimated", "stale", "unknown", "goal", "part")


def build(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    with tag("div", classes="box twin"):
        with tag("div", classes="box-head"):
            tag("h2", words("tab.twin"))
            _cells(layout, words)
            _tools(words)
        with tag("div", id="twin", classes="twin-view"):
            tag("p", words("twin.loading"), id="twin-note", role="status", data_flat=words("twin.flat"))
        _legend(layout, words)
        tag("ul", id="twin-robots", classes="twin-robots", aria_label=words("twin.robots"))
    beside(layout, words, put)


def _cells(layout: Layout, words: Words) -> None:
    with tag("div", classes="filter", role="group", aria_label=words("twin.cells")):
        for name in dict.fromkeys(robot["cell"] for robot in layout["places"]["robots"]):
            does = words("twin.visit", cell=name)
            tag("button", name, type="button", classes="choice", data_twin_cell=name, title=does)


def _tools(words: Words) -> None:
    with tag("div", classes="twin-tools"):
        for name, sign in TOOLS.items():
            does = words(f"twin.{name}")
            tag("button", sign, type="button", classes="tool", data_twin=name, title=does, aria_label=does)


def _legend(layout: Layout, words: Words) -> None:
    kinds = [*KINDS, *(("held", "quarantined") if layout["zones"] else ())]
    with tag("ul", classes="twin-legend", aria_label=words("twin.legend")):
        for kind in kinds:
            with tag("li", title=words(f"twin.about_{kind}")):
                tag("span", classes=f"swatch {kind}")
                tag("span", words(f"twin.{kind}"))
