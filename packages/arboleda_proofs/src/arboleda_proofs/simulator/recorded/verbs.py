"""Record of cells, zones and tasks just before an operator's verb came in.

`refusals_are_foretold` finds by it a verb that is refused though nobody foretells that.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from arboleda.engine.inspection import parts_of, places_of
from arboleda.model.cell_states import CellState
from arboleda.model.messages import OperatorRequest, TaskState
from arboleda.recipes import Sentence
from arboleda.rig.world import World

from .cells import KnownCell
from .tasks import Tasks


@dataclass(slots=True)
class CellSnapshot:
    """A cell after the last step, with what speaks for or against a verb; `waits`: nobody can tell yet what
    became of the step at which an earlier start ended; `parts`: how many each of its places has.
    """

    name: str
    state: CellState
    paused: bool
    queued: int
    has_task: bool
    troubled: bool
    stranded: bool
    waits: bool
    holding: bool
    parts: dict[str, int]


class EarlierState:
    """Cells, zones and tasks just before the step in which somebody asks."""

    def __init__(self) -> None:
        self.cells: list[CellSnapshot] = []
        self.quarantined: dict[str, str] = {}  # zone -> its silent robot
        self.foretold: list[tuple[OperatorRequest, Sentence | None]] = []  # of a verb that comes alone
        self.tasks: dict[str, TaskState] = {}
        self.ids: frozenset[str] = frozenset()  # of all tasks that were accepted and may be remembered

    def look(self, cells: Iterable[KnownCell], tasks: Tasks, world: World) -> None:
        """Take all down before the plant hears the request."""
        plant, requests = world.plant, world.moment.requests
        alone = len(requests) == 1 and not world.moment.reports and world.now < plant.next_deadline
        verbs = [each for each in requests if isinstance(each, OperatorRequest)] if alone else []
        self.foretold = [(each, plant.refusal(each)) for each in verbs]
        self.tasks = {id: task.state for id, task in tasks.open.items()}
        self.ids = frozenset(tasks.open) | frozenset(tasks.ended)
        self.cells = [
            CellSnapshot(
                cell.name,
                run.state,
                run.queue.paused,
                len(run.queue),
                run.task is not None,
                run.trouble is not None,
                run.stranded is not None,
                run.awaits is not None,
                bool(parts_of(cell.run).holding),
                places_of(cell.run).counts,
            )
            for cell in cells
            for run in (cell.run,)
        ]
        zones, names = plant.zones, plant.model.zones
        self.quarantined = {zone: zones.holder(zone) or "" for zone in names if zones.is_quarantined(zone)}
