"""Invariants of plants where another version of the plant is put to work while it runs."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.model import text
from arboleda.model.cell_states import CellState
from arboleda.model.messages import CellRevised, RevisionAnswer, TaskChanged, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.model.revision import revised
from arboleda.recipes import TextError

from .invariant import Look, Trigger, invariant

AT_REST = (CellState.IDLE, CellState.STOPPED, CellState.ABORTED)


@invariant(Trigger.SENT)
def cells_take_versions_between_tasks(look: Look) -> Iterator[str]:
    """A cell takes a version while none of its tasks runs and none of its commands is open."""
    sent, record = look.moment.sent, look.record
    for place, taken in enumerate(sent):
        if not isinstance(taken, CellRevised):
            continue
        running = record.tasks.running.get(taken.cell)
        if running is not None and not any(_begins(each, running) for each in sent[place:]):
            yield f"{taken.cell} took version {taken.version.number} while {running} ran"
        for each in record.commands.open.values():
            if each.entry is not None and each.entry.cell == taken.cell and each.at < record.step.at:
                yield f"{taken.cell} took version {taken.version.number} while {each} was open"


@invariant(Trigger.SENT)
def tasks_that_wait_are_offered(look: Look) -> Iterator[str]:
    """Once a version is put to work, each task that waits is one of it; those that are none have ended."""
    if not any(isinstance(each, RevisionAnswer) and each.refusal is None for each in look.moment.sent):
        return
    for cell, queue in look.record.tasks.queues.items():
        for task in queue.values():
            if not is_offered(look.world.offers, task.message.text):
                yield f"{task.id} waits in {cell}, which does not offer {task.message.text!r} any more"


@invariant(Trigger.END)
def versions_are_taken(look: Look) -> Iterator[str]:
    """At rest each cell without a task works by the version that was put to work last."""
    for cell in look.world.model.cells:
        known, last = look.record.cells[cell.name], look.world.offers.cell(cell.name)
        if known.state in AT_REST and known.task is None and revised(cell, last) != cell:
            yield f"{cell.name} is at rest, and has not taken the last version"


def is_offered(plant: PlantModel, words: str) -> bool:
    """True for the text of a task that a plant takes."""
    try:
        text.parse(words, plant)
    except TextError:
        return False
    return True


def _begins(message: object, task: str) -> bool:
    return isinstance(message, TaskChanged) and message.task == task and message.state is TaskState.RUNNING


REVISIONS = (cells_take_versions_between_tasks, tasks_that_wait_are_offered, versions_are_taken)
"""Invariants where versions are put to work, beside those of every plant."""
