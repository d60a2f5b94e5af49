"""The cells: a card for each, its tree beside it, and what its tree did last."""

from __future__ import annotations

from .plant_side import Layout
from .tags import live, rows, tag
from .wording import Words

MANY = 4  # cells; more than these are shown one tree at a time on a wall screen too


def build(layout: Layout, words: Words) -> None:
    many = "many" if len(layout["cells"]) > MANY else "few"
    with tag("div", classes=f"cells {many}"):
        for cell in layout["cells"]:
            with tag("article", classes="cell", data_cell=cell["name"]):
                _card(cell["name"], words)
                _tree(cell["name"], words)
    _detail(words)


def _card(cell: str, words: Words) -> None:
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
    rows(f"ways.{cell}", ["", ""], classes="ways")


def _tree(cell: str, words: Words) -> None:
    with tag("div", classes="tree-box"):
        with tag("div", classes="tree-tools"):
            live("span", f"{cell}.feedback", classes="feedback")
            for name in ("smaller", "larger", "fit"):
                sign = {"smaller": "−", "larger": "+", "fit": "⤢"}[name]  # noqa: RUF001 - a minus sign
                label = words(f"cells.{name}")
                tag(
                    "button",
                    sign,
                    type="button",
                    classes="tool",
                    data_zoom=name,
                    title=label,
                    aria_label=label,
                )
        tag("p", words("cells.no_tree"), classes="empty")
        tag("div", classes="tree", data_tree=cell, role="tree", aria_label=words("cells.tree", cell=cell))
    with tag("div", classes="changes"):
        tag("h3", words("cells.changes"))
        rows(f"changes.{cell}", ["", "", ""], classes="small")


def _detail(words: Words) -> None:
    """What a click on a node shows; the script fills it."""
    with tag("aside", id="node", hidden="true", aria_live="polite", aria_label=words("node.title")):
        tag("button", "×", type="button", id="node-close", classes="tool", aria_label=words("node.close"))  # noqa: RUF001
        tag("h3", id="node-name")
        tag("p", id="node-state", classes="pill")
        tag("p", id="node-about")
        tag("p", id="node-times")
        tag("p", id="node-feedback")
        tag("p", id="node-failure", classes="trouble", data_label=words("node.failure"))
        tag("dl", id="node-given")
