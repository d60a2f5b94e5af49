"""Rendering of a picture as a PNG by Pillow, which brings its own font."""

from __future__ import annotations

import io
import unicodedata
from collections.abc import Callable
from typing import Any

from PIL import Image, ImageDraw, ImageFont

from arboleda.drawing.picture import FONT, PAPER, Box, Picture, Polyline, Word

SCALE = 2  # dots per px, for screens and projectors alike
SMOOTH = 2  # drawn so many times larger, then reduced: Pillow draws lines without smoothing them


def png(picture: Picture) -> bytes:
    """The picture as a PNG of SCALE dots per px."""
    scale = SCALE * SMOOTH
    size = (round(picture.width * scale), round(picture.height * scale))
    image = Image.new("RGB", size, PAPER)
    pen = _Pen(ImageDraw.Draw(image), scale)
    for shape in picture.shapes:
        pen.draw(shape)
    file = io.BytesIO()
    smooth = image.resize((size[0] // SMOOTH, size[1] // SMOOTH), Image.Resampling.LANCZOS)
    smooth.save(file, "PNG", optimize=True)
    return file.getvalue()


class _Pen:
    """Pen that draws shapes at SCALE dots per px."""

    def __init__(self, draw: ImageDraw.ImageDraw, scale: int) -> None:
        self._draw = draw
        self._scale = scale
        self._font = ImageFont.load_default(size=FONT * scale)
        self._ways: dict[type, Callable[[Any], None]] = {
            Box: self._box,
            Polyline: self._line,
            Word: self._word,
        }

    def draw(self, shape: Box | Polyline | Word) -> None:
        self._ways[type(shape)](shape)

    def _dots(self, *values: float) -> list[float]:
        return [value * self._scale for value in values]

    def _box(self, box: Box) -> None:
        corners = self._dots(box.x, box.y, box.x + box.width, box.y + box.height)
        width = round(1.2 * self._scale)
        self._draw.rounded_rectangle(
            corners, radius=5 * self._scale, fill=box.fill, outline=box.edge, width=width
        )

    def _line(self, line: Polyline) -> None:
        points = [tuple(self._dots(*point)) for point in line.points]
        self._draw.line(points, fill=line.colour, width=round(line.width * self._scale), joint="curve")

    def _word(self, word: Word) -> None:
        at = (word.x * self._scale, word.y * self._scale)
        self._draw.text(at, plain(word.text), fill=word.colour, font=self._font, anchor="lm")


def plain(text: str) -> str:
    """The text in ASCII, which is all that Pillow's font has: without accents, `?` for other letters."""
    bare = "".join(each for each in unicodedata.normalize("NFKD", text) if not unicodedata.combining(each))
    return bare.encode("ascii", "replace").decode()
