"""The ways to draw a tree, as the page's script takes them."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from arboleda.drawing.layout import Layout, Line, Node, columns, outline, wide

Drawing = dict[str, Any]


@lru_cache(maxsize=256)
def drawing(nodes: tuple[Node, ...]) -> Drawing:
    """The widest first, each {w, h, at: {path: [x, y, w]}, lines: {path: d}}."""
    ways = {"wide": wide, "columns": columns, "narrow": outline}
    return {name: _plain(way(nodes)) for name, way in ways.items()}


def _plain(layout: Layout) -> Drawing:
    return {
        "w": layout.width,
        "h": layout.height,
        "at": {path: list(place) for path, place in layout.places.items()},
        "lines": {path: _d(line) for path, line in layout.lines.items()},
    }


def _d(line: Line) -> str:
    """A line as the `d` of an SVG path."""
    return "M" + "L".join(f"{x:g} {y:g}" for x, y in line)
