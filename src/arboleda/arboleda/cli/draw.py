"""Trees as files: the formats, and the library behind each of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any

from arboleda.drawing.picture import picture
from arboleda.drawing.svg import svg
from arboleda.drawing.words import dot, outline
from arboleda.host.packages import extra
from arboleda.model.errors import StartError
from arboleda.model.packages import TREES
from arboleda.model.sentence import Phrase
from arboleda.runtime import invocation

NO_LIBRARY = Phrase(
    "cli.draw.no_library",
    "the library Pillow is not installed, which a PNG needs: type "
    "`{install} 'arboleda[pictures]'`, or take --format svg",
)
Rows = Sequence[dict[str, Any]]


class Format(str, Enum):
    """The formats in which a tree can be drawn."""

    ASCII = "ascii"
    SVG = "svg"
    PNG = "png"
    DOT = "dot"
    XML = "xml"


def draw(rows: Rows, format: Format | str, *, statuses: bool = False) -> bytes:
    """A tree (rows of `views/tree_view.py`) as the content of a file; only ASCII leaves statuses out."""
    return FORMATS[Format(format)](rows, statuses)


def _png(rows: Rows, _statuses: bool) -> bytes:
    try:
        from arboleda.adapters.png import png  # Pillow takes a while to load, and only this format needs it
    except ModuleNotFoundError as error:
        raise StartError(NO_LIBRARY(install=invocation.pip_install())) from error
    return png(picture(rows))


FORMATS: dict[Format, Callable[[Rows, bool], bytes]] = {
    Format.ASCII: lambda rows, statuses: outline(rows, statuses=statuses).encode(),
    Format.SVG: lambda rows, _: svg(picture(rows)).encode(),
    Format.PNG: _png,
    Format.DOT: lambda rows, _: dot(rows).encode(),
    Format.XML: lambda rows, _: extra("export", TREES, "--format xml")(rows).encode(),
}
