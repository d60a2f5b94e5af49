"""Scopes of verbs: the robots and cells that an operator's words name, or a refusal of a name."""

from __future__ import annotations

from arboleda.dispatch.zones import NONE
from arboleda.model.cell_states import CellState
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase, Value
from arboleda.model.verb_scopes import scopes
from arboleda.model.verbs import Scope

from ..cell import CellRun
from ..plant_state import PlantState

NO_TASK = Phrase(
    "refusal.no_task",
    "there is no task {task}; open tasks: {open}; cells and robots of this plant: {known}",
)
AND_MORE = Phrase("and_more", "{first} and {more} more")
NO_SCOPE = Phrase(
    "refusal.no_scope", "{scope} is neither a cell nor a robot of this plant; there are {known}"
)
NOT_HELD = Phrase("refusal.device_not_held", "no cell holds {device} now; say which one, {cells}")
SHOWN = 10  # tasks that a sentence names


class VerbRefusal(ArboledaError):
    """A verb that is refused; the sentence says why, and what is possible."""


class Scopes:
    """Scopes of a plant. `alone` has the cell of each robot that no other cell shares."""

    def __init__(self, state: PlantState) -> None:
        self.cells = state.cells
        cells_of = state.dispatcher.model.cells_of.items()
        self.alone = {name: self.cells[sharing[0].name] for name, sharing in cells_of if len(sharing) == 1}
        self._state = state
        self._robots = scopes(state.dispatcher.model)

    def robots(self, scope: str) -> frozenset[str]:
        """The robots of a scope: the plant, a cell, or one robot."""
        robots = self._robots.get(scope)
        if robots is None:
            raise VerbRefusal(
                NO_SCOPE(scope=quoted(scope), known=(*self.cells, *self._state.dispatcher.beliefs))
            )
        return robots

    def cells_in(self, verb: Verb, scope: str, robots: frozenset[str]) -> list[CellRun]:
        """The cells of a scope with these robots; for most verbs on a shared device its holder."""
        if scope in self.cells:
            return [self.cells[scope]]
        cells = self.of_robots(robots)
        if scope not in self._state.dispatcher.model.shared or verb.row.of_all_who_share:
            return cells
        holder = self._state.zones.holder(scope)
        if holder is None and verb is Verb.RELEASE:
            return [cell for cell in cells if cell.context.devices.answers_for(scope)]
        if holder is None:
            raise VerbRefusal(NOT_HELD(device=scope, cells=tuple(cell.cell.name for cell in cells)))
        return [cell for cell in cells if cell.cell.name == holder]

    def of_robots(self, robots: frozenset[str]) -> list[CellRun]:
        """The cells of robots, in the order of the plant file."""
        cells_of = self._state.dispatcher.model.cells_of
        names = {cell.name for robot in robots for cell in cells_of[robot]}
        if len(names) == 1:  # screens ask about one cell all the time: it needs no search
            return [self.cells[names.pop()]]
        return [cell for name, cell in self.cells.items() if name in names]

    def in_charge(self, robot: str) -> CellRun:
        """The cell of a robot; of a shared robot the cell that holds it, else the first that is idle."""
        if (alone := self.alone.get(robot)) is not None:
            return alone
        runs = [self.cells[cell.name] for cell in self._state.dispatcher.model.cells_of[robot]]
        idle = [run for run in runs if run.state is CellState.IDLE]
        return next((run for run in runs if run.context.devices.holds(robot)), (idle or runs)[0])

    def cell_of(self, request: OperatorRequest, scope: str) -> str | None:
        """The one cell that a request is for; None where it is for more."""
        task = (
            self._state.intake.tasks.get(scope.lstrip("#")) if Scope.TASK in request.verb.row.scopes else None
        )
        if task is not None:
            return task.order.cell
        name = scope.lower()
        cells = self._state.dispatcher.model.cells_of.get(name, ())
        return name if name in self.cells else cells[0].name if len(cells) == 1 else None

    def scope_of_tasks(self, scope: str) -> str:
        """The plant, a cell or a robot whose tasks are meant; VerbRefusal names the tasks that there are."""
        name = scope.lower()
        if name in self._robots:
            return name
        names = (*self.cells, *self._state.dispatcher.beliefs)
        raise VerbRefusal(NO_TASK(task=quoted(scope), open=self._open_tasks(), known=names))

    def _open_tasks(self) -> Value:
        """The ids of open tasks, as many as a sentence can name."""
        ids = tuple(id for id, task in self._state.intake.tasks.items() if task.ended_at is None)
        if len(ids) > SHOWN:
            return AND_MORE(first=ids[:SHOWN], more=len(ids) - SHOWN)
        return ids or NONE()
