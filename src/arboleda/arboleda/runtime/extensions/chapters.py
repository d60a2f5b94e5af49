"""Chapters that packages write into the reports of tasks."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any, Protocol

from arboleda.recorder.chapter import Chapter, chapter

LOG = logging.getLogger(__name__)
SHOWN = 200  # tasks of which screens know that something was written about them


class Keeps(Protocol):
    """Keeper of chapters: the writer of a record."""

    def add(self, chapter: Chapter) -> None: ...


class Chapters:
    """Chapters of reports: kept in the flight record, from which reports are made, here and elsewhere.

    `recorder` gives its writer, None where the plant writes no record: then nothing is kept.
    """

    def __init__(self, recorder: Callable[[], Keeps | None]) -> None:
        self._recorder = recorder
        self._is_said = False
        self._tasks: deque[str] = deque(maxlen=SHOWN)

    def add(
        self,
        package: str,
        task: str,
        title: str,
        text: str = "",
        rows: Iterable[Iterable[object]] = (),
        picture: bytes | None = None,
    ) -> None:
        """Write a chapter; from any thread, waits for nothing. ValueError without a title, and for a picture
        that is no PNG, JPEG or SVG, or is too large."""
        made = chapter(task, package, title, text, rows, picture)
        recorder = self._recorder()
        if recorder is not None:
            recorder.add(made)
            if task not in self._tasks:
                self._tasks.append(task)
        elif not self._is_said:
            self._is_said = True
            LOG.warning(
                "%s writes into the reports of tasks; this plant writes no record to keep it", package
            )

    def rows(self) -> dict[str, Any]:
        """The tasks that chapters were written about, as a snapshot has them."""
        return {"chapters": [*self._tasks]}
