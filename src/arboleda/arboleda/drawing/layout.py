"""Layouts of a tree: places of its nodes from left to right, as outlines side by side, or as one outline."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

ROW, TIGHT_ROW, HEIGHT = 33, 30, 26  # px: from node to node, in an outline, and of a node
CHARACTER, PADDING = 7.4, 40  # px: of the node's font, and around a name with its sign
GAP, INDENT = 26, 20  # px: between two columns, and of an outline's level
MARGIN, BREATH = 4, 6

Node = tuple[str, str]  # path (`root`, `0`, `0.1`, ...), name
NodePlace = tuple[float, float, float]  # x, y, width in px; every node is HEIGHT high
Point = tuple[float, float]
Route = tuple[Point, ...]


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Places by path, and the line that leads to each node but the root; px."""

    width: float
    height: float
    places: dict[str, NodePlace]
    lines: dict[str, Route]


def wide(nodes: Sequence[Node]) -> Layout:
    """The layout with a column per level; a node stands in the line of its first child."""
    widths: dict[int, float] = {}
    for path, name in nodes:
        widths[depth(path)] = max(widths.get(depth(path), 0), _width(name))
    lefts = {level: MARGIN + sum(widths[above] + GAP for above in range(level)) for level in widths}
    inner = {parent(path) for path, _ in nodes}
    places: dict[str, NodePlace] = {}
    line = 0
    for path, _ in nodes:
        places[path] = (lefts[depth(path)], MARGIN + line * ROW, widths[depth(path)])
        line += path not in inner
    return _layout(places, _elbow)


def columns(nodes: Sequence[Node]) -> Layout:
    """The layout with the root on top and below it an outline for each of its branches, side by side."""
    places = {path: (float(MARGIN), float(MARGIN), _width(name)) for path, name in nodes if path == "root"}
    x_of_branch = float(MARGIN)
    for branch in [path for path, _ in nodes if parent(path) == "root"]:
        below = [node for node in nodes if node[0] == branch or node[0].startswith(f"{branch}.")]
        for line, (path, name) in enumerate(below, start=1):
            x = x_of_branch + (depth(path) - 1) * INDENT
            places[path] = (x, MARGIN + line * TIGHT_ROW + BREATH, _width(name))
        x_of_branch = max(places[path][0] + places[path][2] for path, _ in below) + GAP
    return _layout(places, _branch)


def outline(nodes: Sequence[Node]) -> Layout:
    """The layout with a line per node, each level further to the right."""
    places = {
        path: (float(MARGIN + depth(path) * INDENT), float(MARGIN + line * TIGHT_ROW), _width(name))
        for line, (path, name) in enumerate(nodes)
    }
    return _layout(places, _bracket)


def parent(path: str) -> str | None:
    """The path of a node's parent; None for the root."""
    if path == "root":
        return None
    return path.rpartition(".")[0] or "root"


def depth(path: str) -> int:
    """The number of nodes above a node."""
    return 0 if path == "root" else path.count(".") + 1


def _layout(places: dict[str, NodePlace], line: Callable[[NodePlace, NodePlace], Route]) -> Layout:
    return Layout(
        width=max((x + w for x, _, w in places.values()), default=0) + MARGIN,
        height=max((y for _, y, _ in places.values()), default=0) + HEIGHT + MARGIN,
        places=places,
        lines={path: line(places[above], place) for path, place in places.items() if (above := parent(path))},
    )


def _elbow(above: NodePlace, place: NodePlace) -> Route:
    """The line from the right side of a node to the left side of its child."""
    x, y = above[0] + above[2], above[1] + HEIGHT / 2
    to_x, to_y = place[0], place[1] + HEIGHT / 2
    return ((x, y), (x + GAP / 2, y), (x + GAP / 2, to_y), (to_x, to_y))


def _branch(above: NodePlace, place: NodePlace) -> Route:
    """The line down from the root and along to the top of a branch; within a branch as `_bracket`."""
    if above[1] > MARGIN:
        return _bracket(above, place)
    x, y, to_x = above[0] + INDENT / 2, above[1] + HEIGHT, place[0] + INDENT / 2
    return ((x, y), (x, y + BREATH), (to_x, y + BREATH), (to_x, place[1]))


def _bracket(above: NodePlace, place: NodePlace) -> Route:
    """The line down from a node's left end and right to its child."""
    x, y = above[0] + INDENT / 2, above[1] + HEIGHT
    return ((x, y), (x, place[1] + HEIGHT / 2), (place[0], place[1] + HEIGHT / 2))


def _width(name: str) -> float:
    return round(len(name) * CHARACTER + PADDING)
