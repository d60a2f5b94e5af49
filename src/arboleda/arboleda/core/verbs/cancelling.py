"""Cancelling of tasks on the word of an operator, or of a task's own client."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.model.cell_states import CellState
from arboleda.model.messages import Failure, OperatorRequest, Reason, TaskState
from arboleda.model.sentence import Phrase, Sentence

from ..cell import CellRun
from ..plant_state import PlantState
from .cell_by_cell import CellByCell, Doing, in_states
from .scopes import Scopes, VerbRefusal

TASK_ENDED = Phrase("refusal.task_ended", "task {task} has ended already ({state})")
TASK_STATES = {state: Phrase(f"task_state.{state.value}", state.value) for state in TaskState}
NO_RUNNING_TASK = Phrase("refusal.no_running_task", "{cell} has no running task")
BY_OPERATOR = Phrase("task.cancelled_by_operator", "cancelled by the operator")
BY_CLIENT = Phrase("task.cancelled_by_client", "cancelled by the client")
CANCELLED_BY_OPERATOR = Failure(reason=Reason.CANCELLED, sentence=BY_OPERATOR())
CANCELLED_BY_CLIENT = Failure(reason=Reason.CANCELLED, sentence=BY_CLIENT())

_begun = in_states(CellState.EXECUTE, CellState.HELD)


class Cancelling:
    def __init__(self, state: PlantState, scopes: Scopes, doing: Doing) -> None:
        self._state = state
        self._scopes = scopes
        self._in_cells = CellByCell(
            doing, check=_not_cancellable, do=lambda cell, robots: cell.cancel(CANCELLED_BY_OPERATOR)
        )

    def plan(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan the end of one task, or of those that run in a scope."""
        if scope.lstrip("#") in self._state.intake.tasks:
            failure = CANCELLED_BY_CLIENT if request.client else CANCELLED_BY_OPERATOR
            return self._planned_cancel(scope.lstrip("#"), failure)
        scope = self._scopes.scope_of_tasks(scope)
        robots = self._scopes.robots(scope)
        return self._in_cells.planned(robots, self._scopes.cells_in(request.verb, scope, robots))

    def _planned_cancel(self, id: str, failure: Failure) -> Callable[[], None]:
        task = self._state.intake.tasks[id]
        cell = self._scopes.cells[task.order.cell]
        if task.state is TaskState.QUEUED:
            return partial(cell.queue.drop, task, failure)
        if task is not cell.task:
            raise VerbRefusal(TASK_ENDED(task=id, state=TASK_STATES[task.state]()))
        if why := _not_cancellable(cell, frozenset()):
            raise VerbRefusal(why)
        return partial(cell.cancel, failure)


def _not_cancellable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    if cell.task is None:
        return NO_RUNNING_TASK(cell=cell.cell.name)
    return _begun(cell, robots)
