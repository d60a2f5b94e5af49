"""Memory of earlier starts, checked before a plant believes it."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.engine import FACT_VALUES, HISTORY, unsettled
from arboleda.model.errors import StartError
from arboleda.model.messages import Fact, Failure, KeptTask, Reason, TaskState
from arboleda.model.outside import quoted
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.task_rows import (
    ASSISTANT,
    TaskQuery,
    TaskRow,
    answers_of,
    choice_of,
    course_of,
    sentence_of,
    unchecked_of,
)


def remembered(store: PlantMemory) -> dict[Fact, dict[str, str]]:
    """Name to value by kind of fact; StartError if a value is unreadable: it may have been a latch."""
    facts = {fact: store.facts(fact) for fact in Fact}
    for fact, allowed in FACT_VALUES.items():
        for name, value in facts[fact].items():
            if value not in allowed:
                what = f"{quoted(value)} as {fact.value} of {quoted(name)}, which means nothing"
                raise StartError(f"The plant's memory {store.name} says {what}: {store.remedy}.")
    return facts


def begun(
    store: PlantMemory, memory: dict[Fact, dict[str, str]], tasks: Sequence[KeptTask]
) -> dict[Fact, dict[str, str]]:
    """The memory with which a start begins: what a power cut may have undone counts as not settled."""
    changes = [*unsettled(memory, tasks)] if store.may_lack_writes else []
    store.begin(*changes)
    store.sync()  # also what a killed process had only written
    for each in changes:
        memory[each.fact][each.name] = each.value or ""
    return memory


def kept_tasks(store: PlantMemory, *, clock_s: float, unix_s: float) -> list[KeptTask]:
    """The tasks that have not ended, and the last that have, in the order of their acceptance.

    Their times are on the clock that says `clock_s` at the Unix time `unix_s`.
    """
    waiting = store.tasks.select(TaskQuery(is_open=True, limit=None))
    rows = [*waiting, *store.tasks.select(TaskQuery(is_open=False, limit=HISTORY))]
    in_order = sorted(rows, key=lambda row: row.number)
    return [kept_task(row, clock_s=clock_s, unix_s=unix_s) for row in in_order]


def kept_task(row: TaskRow, *, clock_s: float, unix_s: float) -> KeptTask:
    """A task as the plant takes it back, its times on the clock that says `clock_s` at `unix_s`.

    None is later than that: the wall clock of an earlier start may have been ahead.
    """
    started_at, ended_at = (
        None if at is None else clock_s + min(0.0, at - unix_s) for at in (row.started_s, row.ended_s)
    )
    return KeptTask(
        id=row.id,
        text=row.text,
        cell=row.cell,
        state=TaskState(row.state),
        failure=failure_of(row),
        started_at=started_at,
        ended_at=ended_at,
        attempts=row.attempts,
        answers=answers_of(row),
        recipe=row.recipe,
        choice=choice_of(row),
        course=course_of(row),
        unchecked=unchecked_of(row),
        is_bound=row.asked_by == ASSISTANT,
    )


def failure_of(row: TaskRow) -> Failure | None:
    """The failure of a task, as far as it was kept."""
    if row.reason is None:
        return None
    return Failure(reason=Reason(row.reason), sentence=sentence_of(row))
