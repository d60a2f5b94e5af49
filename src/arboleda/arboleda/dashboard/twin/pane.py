"""The twin's pane on the page: the box that the script draws into, and the controls beside it."""

from __future__ import annotations

from ..page_api import Layout
from ..tags import tag
from ..wording import Words

TOOLS = {"reset": "⌂", "top": "▦", "in": "+", "out": "−"}  # noqa: RUF001 - a minus sign
KINDS = ("measured", "estimated", "stale", "unknown", "goal", "part")


def build(layout: Layout, words: Words) -> None:
    with tag("div", classes="box twin"):
        with tag("div", classes="box-head"):
            tag("h2", words("js.twin_plant"), id="twin-title")
            _tools(words)
        with tag("div", id="twin", classes="twin-view"):
            tag("p", words("twin.loading"), id="twin-note", role="status", data_flat=words("twin.flat"))
        tag("ul", id="twin-robots", classes="twin-robots", aria_label=words("twin.robots"))
        with tag("details", classes="twin-how"):
            tag("summary", words("twin.legend"))
            _legend(layout, words)


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
