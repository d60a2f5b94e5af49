"""Guard of the cells: what raises in one of them holds that cell, and nothing else."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.model.cell_states import TABLE, Cause
from arboleda.model.messages import Failure, InternalError, Reason
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase, Sentence

from .cell import CellRun
from .plant_state import PlantState

BROKE_IN_STEP = Phrase("cell.broke_in_step", "{cell}: {kind} in a step: {error}")


class CellGuard:
    """Guard of the cells; `told` has the last error of each cell since the last request of anybody."""

    def __init__(self, state: PlantState) -> None:
        self.told: dict[str, Sentence] = {}
        self._state = state

    def run(self, cell: str, act: Callable[[], None]) -> None:
        """Do something for one cell; where it raises, that cell breaks down and no other."""
        try:
            act()
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self.break_down(cell, error)

    def break_down(self, cell: str, error: Exception) -> None:
        """Hold a cell in which something raised. An equal error is told once until the next request."""
        self._state.news.changes += 1
        self._state.news.revised.add(cell)
        text = plain(" ".join(str(error).split()))
        sentence = BROKE_IN_STEP(cell=cell, kind=type(error).__name__, error=text)
        failure = Failure(reason=Reason.INTERNAL, sentence=sentence)
        if self.told.get(cell) != sentence:
            self.told[cell] = sentence
            self._state.dispatcher.outbox.append(InternalError(cell=cell, error=error))
        self._state.dispatcher.booking.give_up(cell, failure, self._state.clock.now)
        _break_down(self._state.cells[cell], failure)


def _break_down(run: CellRun, failure: Failure) -> None:
    """End the task as failed, and hold the cell unless it is stopped.

    It does not recover, since a recovery is made of the same leaves and rules as what raised.
    """
    run.context.time.go_on()
    run.manual.end(failure.sentence)
    run.interrupt(failure)
    if (run.state, Cause.STUCK) in TABLE:
        run.stuck(failure)
