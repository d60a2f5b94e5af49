"""Reports of tasks that failed as the web server sees them."""

from __future__ import annotations

from abc import abstractmethod
from typing import Protocol


class ReportsApi(Protocol):
    """Reports of one plant."""

    @abstractmethod
    def report(self, task: str) -> str | None:
        """The report on a failed task, as one HTML file; None: it is being written now, ask again. It waits
        for the disk; an ArboledaError says why there is none."""
