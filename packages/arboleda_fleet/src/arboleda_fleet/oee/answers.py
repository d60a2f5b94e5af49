"""OEE of the cells, as the API answers it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated


@dataclass(frozen=True, kw_only=True)
class CellOee:
    """OEE of one cell; shares from 0 to 1, null where `missing` says why nobody can say."""

    cell: str
    since_s: Annotated[float, "Unix time; later than asked where nothing was kept before."]
    until_s: float
    planned_s: Annotated[float, "A task waited or was at work."]
    worked_s: Annotated[float, "Of that, the cell was at work."]
    done: int
    failed: int
    timed: Annotated[int, "Of these, tasks whose shortest time is known."]
    availability: float | None
    performance: float | None
    quality: float | None
    oee: Annotated[float | None, "The three of them multiplied."]
    missing: str | None
