"""News of a step: the cells to which something happened, and the cells whose view changed."""

from __future__ import annotations

from collections.abc import Iterable


class News:
    """News of a step. `touched` has the cells that may have waited for an event of the step.

    `revised` has the cells whose view may have changed. `changes` grows with each change other than a report.
    """

    def __init__(self, cells: Iterable[str]) -> None:
        self.touched = set(cells)
        self.revised: set[str] = set()
        self.changes = 0
