"""News of the cells: to which something happened, and of which people are told something else."""

from __future__ import annotations

from collections.abc import Iterable


class News:
    """News of the cells, in this step.

    `touched` are those to which something happened that they may wait for, `revised` those of which anything
    that is told may have changed. `changes` grows whenever something changed beside what robots report.
    """

    def __init__(self, cells: Iterable[str]) -> None:
        self.touched = set(cells)
        self.revised: set[str] = set()
        self.changes = 0
