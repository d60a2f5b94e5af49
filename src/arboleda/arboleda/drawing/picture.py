"""A tree as shapes in px: boxes, lines and words; a file format only has to draw these three."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import layout
from .layout import HEIGHT, NodePlace, Point

FONT = 13  # px
INK, LINE, PAPER = "#1b2420", "#8b968f", "#ffffff"
STROKE = 1.4
SIGN, MARK = 16, 22  # px: of the sign before a name, and of the mark after it


@dataclass(frozen=True, kw_only=True)
class Box:
    """A rounded box, by its upper left corner."""

    x: float
    y: float
    width: float
    height: float
    fill: str
    edge: str


@dataclass(frozen=True, kw_only=True)
class Polyline:
    """A line through points."""

    points: tuple[Point, ...]
    colour: str
    width: float = STROKE


@dataclass(frozen=True, kw_only=True)
class Word:
    """A text of one line, by the left end of its middle."""

    x: float
    y: float
    text: str
    colour: str = INK


@dataclass(frozen=True, kw_only=True)
class Picture:
    """Shapes on white paper, drawn in their order."""

    width: float
    height: float
    shapes: tuple[Box | Polyline | Word, ...]


@dataclass(frozen=True, kw_only=True)
class StatusStyle:
    """The look of a status: the box, and the strokes of its mark in a square of 10 px."""

    fill: str
    edge: str
    mark: tuple[tuple[Point, ...], ...] = ()


LOOKS = {
    "INVALID": StatusStyle(fill=PAPER, edge="#66706b"),
    "RUNNING": StatusStyle(fill="#e6effc", edge="#1558c0", mark=(((2, 1), (9, 5), (2, 9), (2, 1)),)),
    "SUCCESS": StatusStyle(fill="#e5f3e9", edge="#17713a", mark=(((1, 5), (4, 8), (9, 2)),)),
    "FAILURE": StatusStyle(fill="#fbe9e7", edge="#b3241c", mark=(((2, 2), (8, 8)), ((8, 2), (2, 8)))),
}
ARROW = (((0, 5), (10, 5)), ((6, 1), (10, 5), (6, 9)))
PARALLEL = (((0, 3), (10, 3)), ((6, 0), (10, 3)), ((0, 7), (10, 7)), ((6, 10), (10, 7)))
SIGNS = {"sequence": ARROW, "parallel": PARALLEL}


def picture(rows: Sequence[dict[str, Any]]) -> Picture:
    """The tree of these rows (path, name, kind, status), each node coloured and marked by its status."""
    plan = layout.wide([(row["path"], f"{_room(row['kind'])}{row['name']}") for row in rows])
    lines = [Polyline(points=points, colour=LINE) for points in plan.lines.values()]
    nodes = [shape for row in rows for shape in _node(row, plan.places[row["path"]])]
    return Picture(width=plan.width, height=plan.height, shapes=(*lines, *nodes))


def _node(row: dict[str, Any], place: NodePlace) -> list[Box | Polyline | Word]:
    x, y, width = place
    look, middle = LOOKS[row["status"]], y + HEIGHT / 2
    box = Box(x=x, y=y, width=width, height=HEIGHT, fill=look.fill, edge=look.edge)
    mark = _strokes(look.mark, x + width - MARK + 6, middle - 5, look.edge)
    sign, indent = _sign(row["kind"], x + 7, middle)
    return [box, *sign, Word(x=x + 7 + indent, y=middle, text=str(row["name"])), *mark]


def _sign(kind: str, x: float, middle: float) -> tuple[list[Polyline | Word], float]:
    """The sign before a name, and the room it takes: an arrow for a sequence, `?` for a selector."""
    if kind == "selector":
        return [Word(x=x + 2, y=middle, text="?")], SIGN - 2
    strokes = SIGNS.get(kind, ())
    return _strokes(strokes, x, middle - 5, INK), SIGN if strokes else 0


def _room(kind: str) -> str:
    return "? " if kind == "selector" or kind in SIGNS else ""


def _strokes(strokes: Sequence[Sequence[Point]], x: float, y: float, colour: str) -> list[Any]:
    moved = [tuple((x + dx, y + dy) for dx, dy in stroke) for stroke in strokes]
    return [Polyline(points=points, colour=colour, width=1.8) for points in moved]
