"""The body of every page as HTML: a header, its parts, and the box of details of a tree."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import trees
from .page_api import Layout
from .tags import markup, tag
from .wording import Words

Parts = dict[str, Callable[[Layout, Words], None]]


def body(
    layout: Layout,
    wording: Words,
    parts: Parts,
    *,
    header: Callable[[list[str]], None],
    footer: Callable[[], None] = lambda: None,
) -> str:
    """The HTML of a page, the same for each browser; `header` is called with the names of the parts."""
    shown = parts_of(parts, layout)

    def build() -> None:
        header(list(shown))
        with tag("div", id="parts"):
            for name, build_part in shown.items():
                label = wording.of("tab", name)
                with tag("section", id=f"part-{name}", classes="part", data_part=name, aria_label=label):
                    build_part(layout, wording)
        trees.detail(wording)
        footer()

    return markup(build)


def parts_of(parts: Parts, layout: Layout) -> Parts:
    """The parts of the page that have something to show for this plant: no twin if no robot is drawn."""
    return {name: build for name, build in parts.items() if name != "twin" or layout["places"]["robots"]}


def script_data(wording: Words) -> dict[str, Any]:
    """Data that scripts find as `window.arboledaPage`: the language, and the few words of their own."""
    used = {key[3:]: text for key, text in wording.flat.items() if key.startswith("js.")}
    return {"language": wording.language, "words": used}
