"""Tasks that several cells can do: they go to the best one, and stay there."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.model.messages import TaskState

from .invariant import Look, Trigger, invariant

ROUNDING_S = 1e-6


@invariant(Trigger.TOLD)
def tasks_go_to_the_best_cell(look: Look) -> Iterator[str]:
    """A task that names several cells goes to one that has room and works, as far as there is one, and is
    expected to have done it first; people are told why.
    """
    promises = look.record.choices.promises
    for change in look.record.tasks.changes if promises else ():
        said = change.message
        if said.request is None or said.state is not TaskState.QUEUED or change.answer:
            continue
        if said.cell not in promises:
            yield f"task {said.task} was for {', '.join(promises)}, and went to {said.cell}"
            continue
        chosen = promises[said.cell]
        for cell, promise in promises.items():
            full, hindered, seconds = promise.rank
            if (full, hindered, seconds + ROUNDING_S) < chosen.rank:
                yield f"task {said.task} went to {said.cell} ({chosen}), and {cell} is better ({promise})"
        if not said.choice:
            yield f"task {said.task} went to {said.cell}, and nobody says why"


@invariant(Trigger.TOLD)
def tasks_stay_in_their_cell(look: Look) -> Iterator[str]:
    """A task that was taken in by a cell begins and ends in that cell."""
    for change in look.record.tasks.changes:
        known = look.record.tasks.known(change.message.task)
        state, cell = change.message.state, change.message.cell
        if known is not None and cell != known.cell:
            yield f"task {known.id} was in {known.cell}, and {state.value} in {cell}"


@invariant(Trigger.TOLD)
def courses_are_as_seen(look: Look) -> Iterator[str]:
    """The course that is learned of a done task has its steps' beginnings and its working time as they were
    seen; of a task that an earlier start has begun nothing is learned.
    """
    for change in look.record.tasks.changes:
        said, seen = change.message, look.record.courses.ended.get(change.message.task)
        if said.state is not TaskState.DONE or change.answer or seen is None:
            continue
        if seen.differs(said.course):
            yield f"task {said.task} did not go as it is told: {said.course}"


CHOICES = (tasks_go_to_the_best_cell, tasks_stay_in_their_cell, courses_are_as_seen)
