"""The coded paths of a mobile robot over its 3x3 grid."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise

from arboleda.kinds.floor import Placement
from arboleda.kinds.mobile import Grid, Mobile
from arboleda.model.plant_model import APART_S, Evidence, Path

from .document import Document, Place, choice
from .shapes import MAPPING, NODES

GRID = Grid(origin=Placement(x=0.0, y=0.0), pitch=1.0)
ROUNDING_S = 1e-6
CODE = re.compile(r"[0-9A-Za-z]{2}", re.ASCII)


def exit_of(path: Path) -> str:
    """The exit at which a path ends, as its code calls it: the second character."""
    return path.code[1]


def paths(document: Document, place: Place, grid: Grid = GRID) -> tuple[Path, ...]:
    """Every path of the section; empty, with the problems kept, if one is wrong."""
    document.read_plain(MAPPING, place)
    first_paths: dict[str, str] = {}
    routes = []
    for key in document.keys(place):
        first = first_paths.setdefault(key.upper(), key)
        path = _path(document, (*place, key), grid)
        if not CODE.fullmatch(key):
            document.problem((*place, key), "a path code is two letters or digits", at=(*place, key))
            path = None
        elif first != key:
            document.problem(
                (*place, key), f'is the same code as "{first}", case does not matter', at=(*place, key)
            )
        routes.append(path)
    return tuple(path for path in routes if path) if all(routes) else ()


def check_nodes_show(document: Document, place: Place, routes: Iterable[Path], mobile: Mobile) -> None:
    """Keep a problem for a path that passes its last node before its end, too fast to be shown."""
    edge_s = mobile.grid.pitch / mobile.speed
    if mobile.evidence is not Evidence.JOINTS or edge_s > APART_S - ROUNDING_S:
        return
    for path in routes:
        if path.nodes[-1] in path.nodes[:-1]:
            what = f"path {path.code} comes by its last node before its end, and an edge takes {edge_s:.3g} s"
            why = f"with evidence: joints, an edge must take {APART_S:g} s for each node to be seen"
            longer = f"{mobile.speed * APART_S * 1000:g}"
            document.problem(place, f"{what}; {why}: a pitch_mm of {longer} or more, or a lower speed_mm_s")


def _path(document: Document, place: Place, grid: Grid) -> Path | None:
    nodes = document.read_plain(NODES, place)
    if nodes is None or not _on_grid(document, place, nodes, grid):
        return None
    for index, (node, following) in enumerate(pairwise(nodes), start=1):
        if following not in grid.neighbours(node):
            near = choice(str(neighbour) for neighbour in grid.neighbours(node))
            sentence = f"node {following} is no neighbour of node {node} on the grid; allowed: {near}"
            document.problem((*place, index), sentence)
            return None
    return Path(code=str(place[-1]).upper(), nodes=tuple(nodes))


def _on_grid(document: Document, place: Place, nodes: list[int], grid: Grid) -> bool:
    for index, node in enumerate(nodes):
        if not 0 <= node < grid.size:
            sentence = f"must be a node of the grid, 0 to {grid.size - 1}, is {node}"
            document.problem((*place, index), sentence)
    return all(0 <= node < grid.size for node in nodes)
