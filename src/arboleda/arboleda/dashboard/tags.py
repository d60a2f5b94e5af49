"""Elements of the page: text is always text, never HTML."""

from __future__ import annotations

import json
from typing import Any
from urllib.parse import urlencode

from nicegui import ui
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement


def tag(
    name: str, text: str | None = None, *, classes: str = "", style: str = "", **attributes: Any
) -> Element:
    """`tag("button", "Send", data_act="submit")`; a `with` block fills it."""
    made = ui.element(name) if text is None else TextElement(tag=name, text=text)
    made.style(style)
    for key, value in attributes.items():
        made.props[key.rstrip("_").replace("_", "-")] = value
    return made.classes(classes)


def live(name: str, key: str, *, classes: str = "", **attributes: Any) -> Element:
    """An element whose text and state come with the frames, as `text/<key>`."""
    return tag(name, classes=classes, data_live=key, **attributes)


def link(
    label: str | None, *, tab: str, cell: str | None = None, classes: str = "", **attributes: Any
) -> Element:
    """A link to another place of the page, no task in particular; without a cell the chosen one stays."""
    there = {"tab": tab, "task": None} | ({} if cell is None else {"cell": cell})
    return way(label, there, classes=classes, **attributes)


def way(label: str | None, there: dict[str, str | None], *, classes: str = "", **attributes: Any) -> Element:
    """A link to where `assets/place.js` finds by these keys; what is not among them stays."""
    named = {key: value for key, value in there.items() if value is not None}
    href = f"/?{urlencode(named)}"
    return tag("a", label, classes=classes, href=href, data_go=json.dumps(there), **attributes)


def report(key: str) -> Element:
    """A link to the report of the task whose id is the state of `text/<key>`; the script leads it there."""
    return live("a", key, classes="act to-report", target="_blank", data_report="")


def act_button(label: str, act: str, of: str, does: str, *, classes: str = "", **attributes: Any) -> Element:
    """A button that asks the plant for something; `does` says what it will do."""
    return tag(
        "button",
        label,
        classes=f"act {classes}",
        type="button",
        title=does,
        data_act=act,
        data_of=of,
        **attributes,
    )


def rows(name: str, columns: list[str], *, empty: str = "", classes: str = "") -> None:
    """A table, or a list where no column has a name; its rows come with the frames, as `rows/<name>`.

    `empty` stands where there is none.
    """
    here = {"classes": "rows", "data_rows": name, "data_columns": "|".join(columns)}
    with tag("div", classes=f"table {classes}"):
        if any(columns):
            with tag("div", classes="filled", role="table"):
                with tag("div", classes="row head", role="row"):
                    for column in columns:
                        tag("span", column, role="columnheader")
                tag("div", role="rowgroup", **here)
        else:
            with tag("div", classes="filled"):
                tag("div", role="list", **here)
        tag("p", empty, classes="empty")
