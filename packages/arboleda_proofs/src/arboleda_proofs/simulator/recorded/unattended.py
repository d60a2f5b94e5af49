"""Cells for which nobody has asked for anything since the plant was away, or since it started.

`nothing_moves_after_an_absence` finds by it a plant that was away and goes on as if it had not been.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from arboleda.drivers import Command, Home, Work
from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel

from .cells import KnownCell
from .operator_requests import OperatorRequests
from .scopes import Scopes
from .tasks import Tasks

GETS_GOING = frozenset(verb for verb in Verb if verb.row.moves)


class Unattended:
    """Unattended cells, by name in `cells`, with whether they had something to do as it began.

    `unasked`: motions that the plant sends to such a cell by itself in this step after it was away;
    `stirring`: likewise after a start. `born_at`: when the plant started last, if it has died before.
    """

    def __init__(self, model: PlantModel, scopes: Scopes) -> None:
        self.cells: dict[str, bool] = {}
        self.unasked: list[Command] = []
        self.stirring: list[Command] = []
        self.born_at = -math.inf
        self._model = model
        self._scopes = scopes
        self._since_start = False

    def begin_absence(self, cells: Iterable[KnownCell]) -> None:
        """The plant was away: cells at work do not go on by themselves, unless the plant file says so."""
        self._since_start = False
        self.cells = {
            cell.name: cell.tree is not None or cell.queued > 0
            for cell in cells
            if (cell.tree is not None and not cell.cell.goes_on_after_absence)
            or cell.queued == 0  # tasks may start by themselves where none is under way
        }

    def begin_start(self, now: float, cells: Iterable[KnownCell], tasks: Tasks) -> None:
        """The plant has started: nothing moves by itself but in cells that go on and were not at work."""
        self._since_start, self.born_at = True, now
        self.cells = {
            cell.name: bool(tasks.queues[cell.name]) or cell.run.task is not None
            for cell in cells
            if cell.name in tasks.running or not cell.cell.goes_on
        }

    def attend(self, scope: str) -> None:
        """Somebody gets the cells of a scope going."""
        for name in self._scopes.cells(scope):
            self.cells.pop(name, None)

    def give_task(self, cell: str) -> None:
        """Somebody asks a cell for a task, which counts where it had nothing to do."""
        if not self.cells.get(cell, True):
            del self.cells[cell]

    def judge(self, command: Command, asked: OperatorRequests, *, homes_at_start: bool) -> None:
        """Note a command that moves something in a cell for which nobody has asked for anything since.

        A request for one robot of a cell may move the other: `abandon` of the mobile brings the arm home.
        """
        if not self.cells or not isinstance(command, Work) or asked.cancels_a_task:
            return
        if self._since_start and isinstance(command, Home) and homes_at_start:
            return
        cells = self._model.cells_of[command.robot]
        if any(cell.name not in self.cells for cell in cells):
            return
        if all(GETS_GOING.isdisjoint(asked.verbs(robot.name)) for cell in cells for robot in cell.robots):
            (self.stirring if self._since_start else self.unasked).append(command)

    def clear_news(self) -> None:
        self.unasked.clear()
        self.stirring.clear()
