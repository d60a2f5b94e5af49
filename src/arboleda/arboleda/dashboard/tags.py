"""Markup of the page: text is always text, never HTML."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextvars import ContextVar
from html import escape
from typing import Any
from urllib.parse import urlencode

WITHOUT_END = {"input"}


class Tag:
    """An element of the page; a `with` block fills it."""

    def __init__(self, name: str, text: str, attributes: dict[str, str]) -> None:
        self._name = name
        self._inner: list[str | Tag] = [escape(text, quote=False)]
        self._attributes = attributes

    def __enter__(self) -> Tag:
        _open.get().append(self)
        return self

    def __exit__(self, *_: object) -> None:
        _open.get().pop()

    def take(self, inner: Tag) -> None:
        self._inner.append(inner)

    @property
    def inside(self) -> str:
        return "".join(str(each) for each in self._inner)

    def __str__(self) -> str:
        attributes = "".join(f' {key}="{escape(value)}"' for key, value in self._attributes.items())
        begin = f"<{self._name}{attributes}>"
        return begin if self._name in WITHOUT_END else f"{begin}{self.inside}</{self._name}>"


_open: ContextVar[list[Tag]] = ContextVar("open tags")


def markup(build: Callable[[], object]) -> str:
    """The HTML of all that `build` makes of tags. Elements of NiceGUI would take a hundred times as long, and
    nobody else would get an answer meanwhile."""
    root = Tag("div", "", {})
    before = _open.set([root])
    try:
        build()
    finally:
        _open.reset(before)
    return root.inside


def tag(name: str, text: str | None = None, *, classes: str = "", style: str = "", **attributes: Any) -> Tag:
    """`tag("button", "Send", data_act="submit")`; a `with` block fills it."""
    named = {"class": " ".join(classes.split()), "style": style}
    given = {key: value for key, value in named.items() if value}
    given |= {key.rstrip("_").replace("_", "-"): str(value) for key, value in attributes.items()}
    made = Tag(name, text or "", given)
    _open.get()[-1].take(made)
    return made


def live(name: str, key: str, *, classes: str = "", **attributes: Any) -> Tag:
    """An element whose text and state come with the frames, as `text/<key>`."""
    return tag(name, classes=classes, data_live=key, **attributes)


def link(
    label: str | None, *, tab: str, cell: str | None = None, classes: str = "", **attributes: Any
) -> Tag:
    """A link to another place of the page, no task in particular; without a cell the chosen one stays."""
    there = {"tab": tab, "task": None} | ({} if cell is None else {"cell": cell})
    return way(label, there, classes=classes, **attributes)


def way(label: str | None, there: dict[str, str | None], *, classes: str = "", **attributes: Any) -> Tag:
    """A link to the place of the page with these keys, as `assets/place.js` reads them; others stay."""
    named = {key: value for key, value in there.items() if value is not None}
    href = f"/?{urlencode(named)}"
    return tag("a", label, classes=classes, href=href, data_go=json.dumps(there), **attributes)


def of_task(key: str, address: str, *, classes: str = "") -> Tag:
    """A link to what this address has on the task whose id is the state of `text/<key>`; the script leads it
    there."""
    return live("a", key, classes=classes, target="_blank", data_of_task=address)


def act_button(label: str, act: str, of: str, does: str, *, classes: str = "", **attributes: Any) -> Tag:
    """A button that asks the plant for something; `does` describes its effect."""
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

    `empty` is the text for a list without rows.
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
