"""The body of every page as HTML: a header, the parts by their places, and the box of details of a tree."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import trees
from .page_api import Layout
from .tags import link, markup, tag, way
from .wording import Words

Parts = dict[str, Callable[[Layout, Words], None]]
Places = dict[str, list[str]]  # the names of the parts that a tab of the header leads to, by that of the tab
LOG = "log"
WITHIN = {"events": LOG, "links": LOG}  # the places of parts that share one with others


def body(
    layout: Layout,
    wording: Words,
    parts: Parts,
    *,
    header: Callable[[Places], None],
    footer: Callable[[], None] = lambda: None,
    within: Mapping[str, str] = WITHIN,
) -> str:
    """The HTML of a page, the same for each browser; `header` is called with its places. `within` are the
    places of parts that share one."""
    places = places_of(parts, within)

    def build() -> None:
        header(places)
        with tag("div", id="parts"):
            for place, names in places.items():
                if len(names) > 1:
                    _ways(layout, wording, place, names)
            for name, build_part in parts.items():
                label = wording.of("tab", name)
                with tag("section", id=f"part-{name}", classes="part", data_part=name, aria_label=label):
                    build_part(layout, wording)
        trees.detail(wording)
        footer()

    return markup(build)


def places_of(parts: Parts, within: Mapping[str, str] = WITHIN) -> Places:
    """The parts by the place where they stand; a place stands where its first part does."""
    found: Places = {}
    for name in parts:
        found.setdefault(within.get(name, name), []).append(name)
    return found


def _ways(layout: Layout, wording: Words, place: str, names: list[str]) -> None:
    """Draw the ways from part to part of a place; from the log one leads into the record, too."""
    with tag(
        "nav",
        classes="within",
        aria_label=wording.of("tab", place),
        data_within=" ".join(names),
        hidden="true",
    ):
        for name in names:
            link(wording.of("tab", name), tab=name, classes="tab", data_tab=name, data_parts=name)
        if place == LOG and layout.get("recorded"):
            there = {"tab": "cells", "task": None, "at": "failure"}
            way(wording("record.open"), there, classes="tab")


def script_data(wording: Words) -> dict[str, Any]:
    """Data that scripts find as `window.arboledaPage`: the language, and the few words of their own."""
    used = {key[3:]: text for key, text in wording.flat.items() if key.startswith("js.")}
    return {"language": wording.language, "words": used}
