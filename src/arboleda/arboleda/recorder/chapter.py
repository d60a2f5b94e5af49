"""Chapter that a package writes into the report of a task: a text, a small table, a picture."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

CHAPTER = "chapter/"  # what its attachment to a record begins with
LONGEST_TITLE, LONGEST_TEXT, LONGEST_CELL = 200, 10_000, 300  # letters; what is longer is cut
MOST_ROWS, MOST_CELLS = 200, 20
LARGEST = 2_000_000  # bytes of a picture
PNG, JPEG, SVG = "image/png", "image/jpeg", "image/svg+xml"
BEGINS = {b"\x89PNG\r\n\x1a\n": PNG, b"\xff\xd8\xff": JPEG}
SVG_WITHIN = 1000  # bytes, after a declaration and comments


@dataclass(frozen=True, kw_only=True)
class Chapter:
    """Chapter of the report of a task; `package` is who wrote it. Rows are of cells."""

    task: str
    package: str
    title: str
    text: str = ""
    rows: Sequence[Sequence[str]] = ()
    picture: bytes = b""
    unix_ns: int = 0

    @property
    def name(self) -> str:
        """The name of its attachment."""
        return f"{CHAPTER}{self.task}/{self.unix_ns}.json"

    @property
    def picture_type(self) -> str:
        """The media type of the picture; "" without one."""
        return picture_type(self.picture) if self.picture else ""

    def data(self) -> bytes:
        """The chapter as JSON."""
        row = {**vars(self), "picture": base64.b64encode(self.picture).decode()}
        return json.dumps(row, ensure_ascii=False).encode("utf-8", "replace")


def chapter(
    task: str,
    package: str,
    title: str,
    text: str = "",
    rows: Iterable[Iterable[object]] = (),
    picture: bytes | None = None,
    unix_ns: int = 0,
) -> Chapter:
    """A chapter of what a package says, cut to what a report has room for; ValueError for a picture that is
    none, or is too large, and without a title."""
    if not title.strip():
        raise ValueError("a chapter needs a title")
    if picture:
        picture_type(picture)
    cells = (tuple(str(cell)[:LONGEST_CELL] for cell in row)[:MOST_CELLS] for row in rows)
    return Chapter(
        task=task,
        package=package,
        title=title[:LONGEST_TITLE],
        text=text[:LONGEST_TEXT],
        rows=tuple(cells)[:MOST_ROWS],
        picture=bytes(picture or b""),
        unix_ns=unix_ns,
    )


def chapter_from(data: bytes) -> Chapter:
    """The chapter in the data of an attachment; ValueError for anything else."""
    try:
        row: dict[str, Any] = json.loads(data)
        picture = base64.b64decode(row.pop("picture"), validate=True)
        written = {**row, "title": str(row["title"]), "text": str(row["text"])}
        return chapter(**written, picture=picture)
    except (AttributeError, KeyError, TypeError) as error:
        raise ValueError("it is no chapter of a report") from error


def picture_type(picture: bytes) -> str:
    """The media type of a picture by its first bytes; ValueError for any other, and for one too large."""
    if len(picture) > LARGEST:
        raise ValueError(
            f"a picture of {len(picture) / 1e6:.1f} MB is too large: at most {LARGEST / 1e6:g} MB"
        )
    for begin, kind in BEGINS.items():
        if picture.startswith(begin):
            return kind
    head = picture[:SVG_WITHIN].removeprefix(b"\xef\xbb\xbf").lstrip()
    if head.startswith(b"<") and b"<svg" in head:
        return SVG
    raise ValueError("a picture is PNG, JPEG or SVG; this is none of them")
