"""The order of cells on the page: those in trouble first."""

from __future__ import annotations

from typing import Any

from arboleda.views.view import standing, waited_for

WORST = (
    "aborted",
    "aborting",
    "clearing",
    "stopped",
    "resetting",
    "held",
    "holding",
    "blocked",
    "paused",
    "manual",
    "execute",
    "idle",
)
WELL = ("execute", "idle", "manual")
Row = dict[str, Any]


def trouble_first(snapshot: Row) -> list[Row]:
    """The cells that need somebody, the worst first; the others as in the plant file."""
    waited = waited_for(snapshot)

    def rank(cell: Row) -> tuple[int, bool]:
        stands = standing(cell)
        return len(WORST) if stands in WELL else WORST.index(stands), cell["name"] not in waited

    return sorted(snapshot["cells"], key=rank)
