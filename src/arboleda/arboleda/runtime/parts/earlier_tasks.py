"""Log of tasks that an earlier start left at work: a line for each, once its devices have been heard."""

from __future__ import annotations

from arboleda.engine import Plant, why_held

from .plant_log import TASKS

PATIENCE_S = 5.0  # after which a line is written without what its devices say


class EarlierTasks:
    """Observer of a plant that begins. What it logs is what screens say of the same cell."""

    def __init__(self, plant: Plant) -> None:
        self._untold = {name for name, run in plant.cells.items() if run.keeping.walk is not None}
        self._until = plant.now + PATIENCE_S

    def stepped(self, plant: Plant) -> None:
        """Log each held cell whose task was judged by now."""
        for name in sorted(self._untold):
            run = plant.cells[name]
            if run.awaits is not None and run.stranded is None and plant.now < self._until:
                continue
            self._untold.discard(name)
            if run.keeping.walk is not None and (why := why_held(run)) is not None:
                TASKS.warning("%s", why)
