"""Drawings of a tree, in each of the ways that the page's script knows."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from arboleda.drawing.layout import Layout, Node, Route, columns, outline, wide
from arboleda.model.sentence import Sentence

from .wording import LANGUAGES, Words, words

Drawing = dict[str, Any]
Named = tuple[str, Sentence, str]  # path, the plant's name, kind
WAYS = {"wide": wide, "columns": columns, "narrow": outline}  # the widest first
SIGNS = {"selector": "? ", "sequence": "→ ", "parallel": "⇉ "}  # as behaviour trees are drawn everywhere


def drawing(nodes: tuple[Named, ...], words: Words) -> Drawing:
    """The drawings of a tree by way: {w, h, at: {path: [x, y, w]}, lines: {path: d}}; `need` is the width of
    each in any language."""
    return {**_drawing(_labelled(nodes, words)), "need": _need(nodes)}


def label(name: Sentence, kind: str, words: Words) -> str:
    """The text on a node: the sign of its kind and its name."""
    return SIGNS.get(kind, "") + words.say(name)


def _labelled(nodes: tuple[Named, ...], words: Words) -> tuple[Node, ...]:
    return tuple((path, label(name, kind, words)) for path, name, kind in nodes)


@lru_cache(maxsize=256)
def _drawing(nodes: tuple[Node, ...]) -> Drawing:
    return {name: _plain(way(nodes)) for name, way in WAYS.items()}


@lru_cache(maxsize=256)
def _need(nodes: tuple[Named, ...]) -> dict[str, float]:
    drawn = [_drawing(_labelled(nodes, words(language))) for language in LANGUAGES]
    return {name: max(each[name]["w"] for each in drawn) for name in WAYS}


def _plain(layout: Layout) -> Drawing:
    return {
        "w": layout.width,
        "h": layout.height,
        "at": {path: list(place) for path, place in layout.places.items()},
        "lines": {path: _d(line) for path, line in layout.lines.items()},
    }


def _d(line: Route) -> str:
    """The `d` of an SVG path for a line."""
    return "M" + "L".join(f"{x:g} {y:g}" for x, y in line)
