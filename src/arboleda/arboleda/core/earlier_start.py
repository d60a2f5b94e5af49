"""Cells as an earlier start left them: stopped, taught, or with a task that is held at its step.

A latch is kept by robot, and not by cell. So the cells that were stopped are worked out: a shared robot may
be latched because of another cell.
"""

from __future__ import annotations

from arboleda.dispatch.fact_memory import FactMemory
from arboleda.dispatch.latches import Latches
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Fact
from arboleda.model.plant_model import Cell, PlantModel

from .cell import CellRun


def look_back(run: CellRun) -> None:
    """Judge a task of an earlier start by the reports of its devices until now."""
    if run.keeping.walk is not None and run.state is CellState.HELD:
        run.judge()


def trail_of(run: CellRun) -> str | None:
    """The trail of a cell's task, to be kept; None where this very trail was kept last."""
    if run.task is None or run.run.tree is None:
        return None
    holds = run.state in (CellState.HOLDING, CellState.HELD)
    why, cancels = run.task.failure, run.cancelling
    return run.keeping.news(failure=why, cancels=cancels, holds=holds, stranded=run.stranded)


def stop_of(cell: Cell, model: PlantModel, latches: Latches) -> CellState | None:
    """The state of a cell that was stopped in an earlier start; None where it was not stopped."""
    if _was_stopped(cell, model, latches.stopped):
        return CellState.ABORTED
    return CellState.STOPPED if _was_stopped(cell, model, latches.cleared) else None


def _was_stopped(cell: Cell, model: PlantModel, stopped: set[str]) -> bool:
    """True where a robot of the cell alone is stopped, or a shared one that no other cell's stop explains."""
    if not stopped.isdisjoint(cell.own):
        return True
    for name in stopped.intersection(cell.shared):
        if all(stopped.isdisjoint(other.own) for other in model.cells_of[name]):
            return True
    return False


def end_teaching(cells: dict[str, CellRun], memory: FactMemory) -> None:
    """Pause the queues of cells that were taught when an earlier start ended: a person may stand there."""
    for name in sorted(memory.names(Fact.MANUAL)):
        memory.remember(Fact.MANUAL, name, None)
        if name in cells:
            cells[name].queue.paused = True
