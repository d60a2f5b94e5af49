"""What somebody who does not look is told, as plain data: a task that failed, a cell that needs somebody."""

from __future__ import annotations

from typing import Any

from arboleda.core.advice import in_words
from arboleda.core.cell_states import CellState
from arboleda.core.plant import Plant
from arboleda.model.messages import TaskChanged
from arboleda.model.outside import plain
from arboleda.model.sentence import NOTHING, Phrase, Sentence

Alarm = dict[str, Any]
TASK_FAILED, CELL_HELD, CELL_CLEARED = "task_failed", "cell_held", "cell_cleared"
NEEDS_SOMEBODY = frozenset({CellState.HELD, CellState.ABORTED, CellState.STOPPED})
AT_WORK_AGAIN = frozenset({CellState.IDLE, CellState.EXECUTE})
CLEARED = Phrase("alarm.cleared", "{cell} needs nobody any more: it is {state}")
# The longest packet of the plant's own broker has 4096 bytes, and a letter has up to four.
LONGEST, MOST = 300, 6


def of_task(plant: Plant, failed: TaskChanged) -> Alarm:
    """A task that failed, and what its cell asks for now."""
    reason = failed.reason.value if failed.reason else None
    task = _task(failed.task, failed.text)
    return _alarm(plant, failed.cell or "", TASK_FAILED, task, reason, failed.sentence)


def of_cell(plant: Plant, cell: str) -> Alarm:
    """A cell that stands and needs somebody, or needs nobody any more."""
    run = plant.cells[cell]
    task = _task(run.task.id, run.task.order.text) if run.task else None
    if run.state not in NEEDS_SOMEBODY:
        return _alarm(plant, cell, CELL_CLEARED, task, None, CLEARED(cell=cell, state=run.state.said))
    reason = run.trouble.reason.value if run.trouble else None
    return _alarm(plant, cell, CELL_HELD, task, reason, run.waiting_for() or NOTHING)


def _alarm(
    plant: Plant, cell: str, kind: str, task: Alarm | None, reason: str | None, sentence: Sentence
) -> Alarm:
    run = plant.cells.get(cell)  # None where the plant file has it no more
    ways = plant.advice(cell) if run else ()
    return {
        "kind": kind,
        "plant": plant.model.name,
        "cell": cell,
        "state": run.state.value if run else None,
        "task": task,
        "reason": reason,
        "sentence": _short(sentence),
        "advice": [_short(in_words(each)) for each in ways[:MOST]],
    }


def _task(id: str, text: str) -> Alarm:
    return {"id": _short(id), "text": _short(text)}


def _short(said: object) -> str:
    return plain(str(said), LONGEST)
