"""The menu of a cell or of the whole plant: the operator's verbs, and what packages add."""

from __future__ import annotations

from . import panel
from .page_api import Layout
from .page_part import Place, Put, put_nothing
from .tags import tag
from .wording import Words

PLANT = ""


def build(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    """Draw the one menu of the page; its script shows in it what is of the cell, or of the plant."""
    with tag("aside", id="menu", hidden="true", tabindex="-1", aria_label=words("panel.title")):
        close = words("menu.close")
        tag("button", "×", type="button", id="menu-close", classes="tool", title=close, aria_label=close)  # noqa: RUF001
        panel.build(layout, words)
        with tag("div", classes="part", data_menu_of="cell", hidden="true"):
            put(Place.CELL_MENU)
        with tag("div", classes="part", data_menu_of="plant", hidden="true"):
            panel.zones(words, "acts")
            put(Place.PLANT_MENU)


def opener(of: str, label: str, name: str) -> None:
    """Draw the button that opens the menu of the cell `of`, or of the plant; `name` is for who hears it."""
    tag(
        "button",
        label,
        type="button",
        classes="act menu-open",
        aria_label=name,
        aria_controls="menu",
        aria_expanded="false",
        data_menu=of,
    )
