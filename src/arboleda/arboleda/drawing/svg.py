"""A picture as SVG text."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

from .picture import FONT, PAPER, Box, Picture, Polyline, Word

FAMILY = "system-ui, 'DejaVu Sans', Arial, sans-serif"


def svg(picture: Picture) -> str:
    """The picture as an SVG file that needs no other file."""
    size = f'width="{picture.width:g}" height="{picture.height:g}"'
    view = f'viewBox="0 0 {picture.width:g} {picture.height:g}"'
    font = f'font-family="{FAMILY}" font-size="{FONT}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} {view} {font}>'
    paper = f'<rect width="100%" height="100%" fill="{PAPER}"/>'
    return "\n".join([head, paper, *(WRITERS[type(shape)](shape) for shape in picture.shapes), "</svg>\n"])


def _box(box: Box) -> str:
    at = f'x="{box.x:g}" y="{box.y:g}" width="{box.width:g}" height="{box.height:g}"'
    return f'<rect {at} rx="5" fill="{box.fill}" stroke="{box.edge}" stroke-width="1.2"/>'


def _line(line: Polyline) -> str:
    points = " ".join(f"{x:g},{y:g}" for x, y in line.points)
    stroke = f'stroke="{line.colour}" stroke-width="{line.width:g}" stroke-linejoin="round"'
    return f'<polyline points="{points}" fill="none" {stroke}/>'


def _word(word: Word) -> str:
    # dominant-baseline is not known to every viewer; 0.35 em below the middle is the baseline in all of them
    at = f'x="{word.x:g}" y="{word.y + 0.35 * FONT:g}"'
    return f'<text {at} fill="{word.colour}">{escape(word.text, quote=False)}</text>'


WRITERS: dict[type, Callable[[Any], str]] = {Box: _box, Polyline: _line, Word: _word}
