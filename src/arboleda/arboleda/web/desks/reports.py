"""Reports of tasks that failed as the web server sees them."""

from __future__ import annotations

from abc import abstractmethod
from typing import Protocol

from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import Phrase

NO_RECORD = Phrase("report.no_record", "this plant writes no record, of which reports are made")


class NoReport(ArboledaError):
    """There is no report of a task; the sentence says why."""


class ReportsApi(Protocol):
    """Reports of one plant."""

    @abstractmethod
    def report(self, task: str) -> str | None:
        """The report on a failed task, as one HTML file; None: it is being written now, ask again. It waits
        for the disk; an ArboledaError says why there is none."""
