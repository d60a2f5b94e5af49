"""Record of the times in which cells stood and in which the plant ran, over all starts.

`oee_is_as_seen` finds by it a task that counts though it was done before the time asked for.
"""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.model.cell_states import CellState
from arboleda.oee.figures import Downtime, PlantRun

from .cells import KnownCell

AT_WORK = frozenset({CellState.IDLE, CellState.EXECUTE})


class Times:
    """Times of standing cells and of the plant's starts, as its memory should have them; s of the world."""

    def __init__(self, now: float) -> None:
        self._starts = [now]
        self._ends: list[float] = []  # of all starts but the last
        self._stands: dict[str, float] = {}  # cells that stand, since when
        self._downs: list[Downtime] = []

    def restart(self, last: float, now: float) -> None:
        """Begin another start: the plant was seen `last` before it died, and starts at `now`."""
        self._ends.append(last)
        self._starts.append(now)
        for name in list(self._stands):
            self._stand_no_more(name, last)

    def look(self, cells: Iterable[KnownCell], now: float) -> None:
        """Take in which cells stand after a step."""
        for cell in cells:
            if cell.state not in AT_WORK:
                self._stands.setdefault(cell.name, now)
            elif cell.name in self._stands:
                self._stand_no_more(cell.name, now)

    def runs(self, now: float, *, ended: bool) -> list[PlantRun]:
        """All starts; `ended`: the last one ends now, and was not killed."""
        return [
            PlantRun(since_s=since, seen_s=end, ended=ended and number == len(self._ends))
            for number, (since, end) in enumerate(zip(self._starts, [*self._ends, now], strict=True))
        ]

    @property
    def downs(self) -> list[Downtime]:
        """All times in which cells stood, those that last at the end."""
        lasting = [Downtime(cell=name, since_s=since, until_s=None) for name, since in self._stands.items()]
        return [*self._downs, *lasting]

    def _stand_no_more(self, name: str, now: float) -> None:
        self._downs.append(Downtime(cell=name, since_s=self._stands.pop(name), until_s=now))
