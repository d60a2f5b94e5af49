"""Commands of tasks that did not leave the plant, as something was in their way."""

from __future__ import annotations

from arboleda.engine import Entry, Plant
from arboleda.engine.inspection import not_given_count_of, not_given_of


class RefusedCommands:
    """Reader of those commands, each of which it gives once."""

    def __init__(self) -> None:
        self._plant: Plant | None = None
        self._count = 0

    def fresh(self, plant: Plant) -> list[Entry]:
        """Those since it was last asked, of the plant that runs now."""
        if plant is not self._plant:
            self._plant, self._count = plant, 0
        count = not_given_count_of(plant) - self._count
        self._count += count
        return list(not_given_of(plant))[-count:] if count else []
