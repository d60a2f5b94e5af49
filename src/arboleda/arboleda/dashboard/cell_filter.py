"""Filter of a list: a button for each cell, and one for all."""

from __future__ import annotations

from .page_api import Layout
from .tags import tag
from .wording import Words


def cell_filter(name: str, layout: Layout, words: Words) -> None:
    """Draw the buttons that leave only the rows of one cell in the list `name`."""
    with tag("div", classes="filter", role="group", aria_label=words("page.filter")):
        for value, text in [("", words("page.all")), *((c["name"], c["name"]) for c in layout["cells"])]:
            pressed = "true" if value == "" else "false"
            tag(
                "button",
                text,
                type="button",
                classes="choice",
                data_filter=name,
                data_value=value,
                aria_pressed=pressed,
            )
