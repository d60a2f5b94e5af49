"""Commands of tasks that did not leave the plant, as something was in their way."""

from __future__ import annotations

from arboleda.core.plant import Plant
from arboleda.dispatch.ledger import Entry


class RefusedCommands:
    """Reader of those commands, each of which it gives once."""

    def __init__(self) -> None:
        self._plant: Plant | None = None
        self._count = 0

    def fresh(self, plant: Plant) -> list[Entry]:
        """Those since it was last asked, of the plant that runs now."""
        if plant is not self._plant:
            self._plant, self._count = plant, 0
        count = plant.dispatcher.not_given_count - self._count
        self._count += count
        return list(plant.dispatcher.not_given)[-count:] if count else []
