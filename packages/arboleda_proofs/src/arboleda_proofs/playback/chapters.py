"""Chapters of reports in the files of a record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path

from arboleda.recorder import chapter, files
from arboleda.recorder.chapter import Chapter
from arboleda.recorder.reader import Record

from .chunks import ChunkFile


def chapters_of(record: Record, task: str, *, later: bool) -> list[Chapter]:
    """The chapters of the report of a task in its record and, if wanted, in later ones beside it, in which a
    package may have written about it, too."""
    first = files.part_at(record.paths[0])
    if not later or first is None:
        return chapters_in(record.paths, task)
    return chapters_in([each.path for each in files.parts_in(first.path.parent) if each >= first], task)


def chapters_in(paths: Iterable[Path], task: str) -> list[Chapter]:
    """The chapters of the report of a task, in the order in which they were written; what is damaged is left
    out."""
    return [each for path in paths for each in _chapters(ChunkFile(path), f"{chapter.CHAPTER}{task}/")]


def _chapters(file: ChunkFile, begin: str) -> Iterator[Chapter]:
    with suppress(OSError, ValueError, *files.TORN):
        for name, offset in file.index().attachments:
            if name.startswith(begin):
                with suppress(ValueError, *files.TORN):
                    yield chapter.chapter_from(file.attachment(offset))
