"""A task and the states it passes through."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .errors import IllegalTransition
from .messages import Check, Course, Failure, KeptTask, TaskAnswer, TaskState
from .sentence import NOTHING, Phrase, Sentence


@dataclass(frozen=True, kw_only=True)
class Order:
    """A parsed task text: canonical words, the id after `#`, if any, and the value of each parameter.

    `short` is the text without the name of a default recipe, by which earlier versions kept it.
    """

    text: str
    cell: str
    recipe: str
    id: str | None = None
    values: Mapping[str, Any] = field(default_factory=dict)
    short: str = ""

    def is_alike(self, other: Order) -> bool:
        """True for the text of the same work, as this version or an earlier one kept it."""
        return self.text in (other.text, other.short)


LEGAL: dict[TaskState, frozenset[TaskState]] = {
    TaskState.QUEUED: frozenset({TaskState.RUNNING, TaskState.CANCELLED}),
    TaskState.RUNNING: frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED}),
    TaskState.DONE: frozenset(),
    TaskState.FAILED: frozenset(),
    TaskState.CANCELLED: frozenset(),
}

UNCHECKED: dict[tuple[Check, ...], Phrase] = {
    (Check.GRIP,): Phrase("task.unchecked_grip", "not checked: whether the part was gripped"),
    (Check.RELEASE,): Phrase("task.unchecked_release", "not checked: whether the part was let go of"),
    (Check.GRIP, Check.RELEASE): Phrase(
        "task.unchecked_both", "not checked: whether the part was gripped and let go of"
    ),
}


class Task:
    """Accepted order on its way through the plant; times in s of the plant's clock.

    `choice` says why it is done in this cell, where several were allowed; else None.
    """

    def __init__(self, id: str, order: Order, choice: Sentence | None = None) -> None:
        self.id = id
        self.order = order
        self.choice = choice
        self.state = TaskState.QUEUED
        self.failure: Failure | None = None
        self.failed_in: str | None = None  # the path of the leaf that named its failure
        self.failed_step: Sentence | None = None  # the name of that leaf, in this start of the plant
        self.started_at: float | None = None
        self.ended_at: float | None = None
        self.attempts = 0  # how often its work was begun, or its step given again by a retry
        self.answers: list[TaskAnswer] = []  # in the order in which they came
        self.course: Course | None = None  # how it went, once it is done
        self.unchecked: tuple[Check, ...] = ()  # of its work, once it is done
        self.version = ""  # the digest of the only version of the plant by which it may begin, "" for any
        self.is_kept = False  # True where an earlier start accepted it

    @classmethod
    def of(cls, record: KeptTask, order: Order | None = None) -> Task:
        """The task of a record; without an order it can only be looked at."""
        looked_at = Order(text=record.text, cell=record.cell, recipe=record.recipe)
        task = cls(record.id, order or looked_at, record.choice)
        task.state, task.failure = record.state, record.failure
        task.started_at, task.ended_at, task.is_kept = record.started_at, record.ended_at, True
        task.attempts, task.answers, task.course = record.attempts, list(record.answers), record.course
        task.unchecked = record.unchecked
        return task

    @property
    def remark(self) -> Sentence:
        """The reason of its failure, or the work of a done task that nobody confirmed."""
        if self.failure is not None:
            return self.failure.sentence
        return UNCHECKED[self.unchecked]() if self.unchecked else NOTHING

    def become(self, state: TaskState, now: float) -> None:
        """Move to `state`; IllegalTransition where the table has no such step."""
        if state not in LEGAL[self.state]:
            raise IllegalTransition(f"task {self.id} cannot go from {self.state.value} to {state.value}")
        self.state = state
        if state is TaskState.RUNNING:
            self.started_at = now
            self.attempts += 1
        else:
            self.ended_at = now

    def fail(self, failure: Failure, leaf: str | None = None, step: Sentence | None = None) -> None:
        """Keep the first cause of a failure, with path and name of its leaf; later causes follow from it."""
        if self.failure is None:
            self.failure, self.failed_in, self.failed_step = failure, leaf, step
