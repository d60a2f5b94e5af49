"""Tasks, as they are and as the history has them, and what an operator's verb came to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any

from arboleda.model.facts import Value
from arboleda.model.verbs import Outcome, Verb

VerbWord = Annotated[str, Verb]
OutcomeWord = Annotated[str, Outcome]

OUTCOME = (
    "sent: a stop; whether robots stand shows in what they report; or a hold that the plant has yet to do. "
    "under_way: devices were told to. done. unchecked: devices were told, and report nothing of it. failed."
)
KEPT_CHOICE = "Why it was given to its cell, if others were allowed; of an assistant's, who approved it."
CHOICE = "Why it is done in this cell, where several were allowed."
UNCHECKED = "Of one that is done what no device confirmed: grip, release; its sentence says it for people."

ENDED = frozenset({"done", "failed", "cancelled"})


@dataclass(frozen=True, kw_only=True)
class TaskAnswer:
    """Answer that a device or a person gave while a task ran."""

    by: str
    asked: Annotated[str, "The question, or the verb and its values."]
    answer: Value


@dataclass(frozen=True, kw_only=True)
class Task:
    """Task of the plant; `state` is queued, running, done, failed, cancelled or refused."""

    id: str
    text: str
    cell: str | None
    state: Annotated[str, "queued, running, done, failed, cancelled or refused."]
    reason: str | None = None
    sentence: str = ""
    key: Annotated[str | None, "What its sentence says, as of a Sentence."] = None
    values: dict[str, Any] | None = None
    answers: Annotated[list[TaskAnswer], "Of this task, in the order they came."] = field(
        default_factory=list
    )
    choice: Annotated[str | None, CHOICE] = None
    unchecked: Annotated[list[str], UNCHECKED] = field(default_factory=list)

    @property
    def has_ended(self) -> bool:
        return self.state in ENDED


@dataclass(frozen=True, kw_only=True)
class KeptTask:
    """A task of this start or of an earlier one; times are Unix times, in seconds."""

    number: Annotated[int, "Grows by one with each task that the plant accepts."]
    id: str
    text: str
    cell: str
    recipe: str
    state: Annotated[str, "queued, running, done, failed or cancelled."]
    reason: str | None = None
    sentence: str = ""
    key: Annotated[str | None, "What its sentence says, as of a Sentence."] = None
    values: dict[str, Any] | None = None
    accepted_s: float
    started_s: float | None = None
    ended_s: float | None = None
    asked_by: Annotated[
        str | None, "The way by which it came: command, page, http, ros2, demo, assistant; null: not known."
    ] = None
    attempts: Annotated[int, "How often it was begun, or tried again by `retry`."] = 0
    answers: Annotated[list[TaskAnswer], "Of one that has ended, in their order."] = field(
        default_factory=list
    )
    choice: Annotated[str | None, KEPT_CHOICE] = None
    unchecked: Annotated[list[str], UNCHECKED] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class Done:
    """Outcome of a verb that is not refused; while `under_way`, `GET /api/acts/<act>` tells its end."""

    verb: VerbWord
    scope: Annotated[str, "A cell, robot, zone or task id; empty for the whole plant."]
    act: Annotated[int | None, "Its number, in this start of the plant."] = None
    outcome: Annotated[OutcomeWord | None, OUTCOME] = None
    why: Annotated[str | None, "Why it failed, cannot be checked, or is not kept."] = None


@dataclass(frozen=True, kw_only=True)
class Act:
    """Act of an operator, with its present outcome."""

    number: Annotated[int, "Grows by one with each act; of this start of the plant."]
    at: Annotated[float, "On the plant's clock."]
    verb: VerbWord
    scope: str
    cell: Annotated[str | None, "Null where it is of several."]
    sentence: str
    outcome: Annotated[OutcomeWord, OUTCOME]
    why: Annotated[str | None, "Why it failed, or cannot be checked."]
    ended_at: Annotated[float | None, "When that was known, where it was not with the act."]
    ended: Annotated[str | None, "Its end in words, then."]
