"""Where the nodes of a tree are drawn: from left to right, as outlines side by side, or as one outline."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from .tree_memory import parent

ROW, TIGHT_ROW, HEIGHT = 33, 30, 26  # px: from node to node, in an outline, and of a node
CHARACTER, PADDING = 7.4, 40  # px: of the node's font, and around a name with its sign
GAP, INDENT = 26, 20  # px: between two columns, and of an outline's level
MARGIN, BREATH = 4, 6

Node = tuple[str, str]  # path, name
Drawing = dict[str, Any]
Place = tuple[float, float, float]  # x, y, width in px


@lru_cache(maxsize=256)
def drawing(nodes: tuple[Node, ...]) -> Drawing:
    """The ways to draw a tree, the widest first, each {w, h, at: {path: [x, y, w]}, lines: {path: d}}."""
    return {
        "wide": _drawn(_wide(nodes), _elbow),
        "columns": _drawn(_columns(nodes), _branch),
        "narrow": _drawn(_narrow(nodes), _bracket),
    }


def _drawn(at: dict[str, Place], line: Any) -> Drawing:
    lines = {path: line(at[above], place) for path, place in at.items() if (above := parent(path))}
    return {
        "w": max((x + w for x, _, w in at.values()), default=0) + MARGIN,
        "h": max((y for _, y, _ in at.values()), default=0) + HEIGHT + MARGIN,
        "at": {path: list(at[path]) for path in at},
        "lines": lines,
    }


def _wide(nodes: tuple[Node, ...]) -> dict[str, Place]:
    """A column per level, a line per leaf; a node stands in the line of its first child."""
    widths: dict[int, float] = {}
    for path, name in nodes:
        widths[_depth(path)] = max(widths.get(_depth(path), 0), _width(name))
    lefts = {level: MARGIN + sum(widths[above] + GAP for above in range(level)) for level in widths}
    inner = {parent(path) for path, _ in nodes}
    at: dict[str, Place] = {}
    line = 0
    for path, _ in nodes:
        at[path] = (lefts[_depth(path)], MARGIN + line * ROW, widths[_depth(path)])
        line += path not in inner
    return at


def _narrow(nodes: tuple[Node, ...]) -> dict[str, Place]:
    """A line per node, each level further to the right."""
    return {
        path: (MARGIN + _depth(path) * INDENT, MARGIN + line * TIGHT_ROW, _width(name))
        for line, (path, name) in enumerate(nodes)
    }


def _columns(nodes: tuple[Node, ...]) -> dict[str, Place]:
    """The root on top, below it an outline for each of its branches, side by side."""
    at = {path: (float(MARGIN), float(MARGIN), _width(name)) for path, name in nodes if path == "root"}
    left = float(MARGIN)
    for branch in [path for path, _ in nodes if parent(path) == "root"]:
        below = tuple(node for node in nodes if node[0] == branch or node[0].startswith(f"{branch}."))
        for line, (path, name) in enumerate(below, start=1):
            x = left + (_depth(path) - 1) * INDENT
            at[path] = (x, MARGIN + line * TIGHT_ROW + BREATH, _width(name))
        left = max(at[path][0] + at[path][2] for path, _ in below) + GAP
    return at


def _elbow(above: Place, place: Place) -> str:
    """From the right side of a node to the left side of its child."""
    x, y = above[0] + above[2], above[1] + HEIGHT / 2
    to_x, to_y = place[0], place[1] + HEIGHT / 2
    return f"M{x:g} {y:g}H{x + GAP / 2:g}V{to_y:g}H{to_x:g}"


def _branch(above: Place, place: Place) -> str:
    """Down from the root and along to the top of a branch; within one as `_bracket`."""
    if above[1] > MARGIN:
        return _bracket(above, place)
    x, y = above[0] + INDENT / 2, above[1] + HEIGHT
    return f"M{x:g} {y:g}V{y + BREATH:g}H{place[0] + INDENT / 2:g}V{place[1]:g}"


def _bracket(above: Place, place: Place) -> str:
    """Down from a node's left end and right to its child."""
    x, y = above[0] + INDENT / 2, above[1] + HEIGHT
    return f"M{x:g} {y:g}V{place[1] + HEIGHT / 2:g}H{place[0]:g}"


def _depth(path: str) -> int:
    return 0 if path == "root" else path.count(".") + 1


def _width(name: str) -> float:
    return round(len(name) * CHARACTER + PADDING)
