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
        message = change.message
        if message.request is None or message.state is not TaskState.QUEUED or change.answer:
            continue
        if message.cell not in promises:
            yield f"task {message.task} was for {', '.join(promises)}, and went to {message.cell}"
            continue
        chosen = promises[message.cell]
        for cell, promise in promises.items():
            full, hindered, seconds = promise.rank
            if (full, hindered, seconds + ROUNDING_S) < chosen.rank:
                went = f"task {message.task} went to {message.cell} ({chosen})"
                yield f"{went}, and {cell} is better ({promise})"
        if not message.choice:
            yield f"task {message.task} went to {message.cell}, and nobody says why"


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
        message, course = change.message, look.record.courses.ended.get(change.message.task)
        if message.state is not TaskState.DONE or change.answer or course is None:
            continue
        if course.differs(message.course):
            yield f"task {message.task} did not go as it is told: {message.course}"


CHOICES = (tasks_go_to_the_best_cell, tasks_stay_in_their_cell, courses_are_as_seen)
