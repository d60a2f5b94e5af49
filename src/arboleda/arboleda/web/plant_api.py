"""What the web side may ask of the plant: look, and post task texts and operators' verbs; nothing else."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any, Protocol

from arboleda.model.facts import Value
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.store.oee_rows import OeeQuery
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.views.oee import Oee

COMMAND_LINE = "arboleda"  # what our own command says it is, before its version
Snapshot = dict[str, Any]


class PlantApi(Protocol):
    """The plant as the server sees it; no call blocks that does not say so, and all data is plain."""

    def snapshot(self) -> Snapshot:
        """The plant as it is kept; while it waits for its disk, as it was before."""

    def latest(self) -> Snapshot:
        """The same, with all that anybody was answered; it waits for the disk, at most for a second."""

    def offers(self) -> list[dict[str, Any]]:
        """By cell, its recipes with their parameters and what these can be."""

    def spelled(self, *, cell: str, recipe: str, values: Mapping[str, Value], id: str) -> str:
        """The text of a task whose values are named; TextError for what is no task of this plant."""

    def find(self, task: str) -> dict[str, Any] | None:
        """One task by its id, None where the plant knows none; it waits for the disk, at most a second."""

    def history(self, query: TaskQuery) -> list[TaskRow]:
        """Tasks of this start and of earlier ones; it waits for the disk."""

    def oee(self, query: OeeQuery) -> list[Oee]:
        """The figures of its cells, in the order of the plant file; it waits for the disk."""

    def promises(self, text: str) -> list[dict[str, Any]]:
        """What each cell that a task text names promises now; TextError, QueueFull."""

    def submit(self, text: str, asked_by: str, choice: str = "") -> Future[dict[str, Any]]:
        """A future of the task. A state `refused` or a TextError in it is the caller's mistake, any other
        ArboledaError means "not now". `choice` is why it was given to its cell, where somebody chose."""

    def operate(self, verb: Verb, scope: str, *, by_hand: bool = False) -> Future[OperatorAnswer]:
        """A future of what became of the verb; `scope` is "" for the whole plant."""

    def act(self, number: int) -> dict[str, Any] | None:
        """One of the last acts of operators by its number, None where the plant knows it no more."""

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        """Have each changed snapshot told in the plant's thread, which must not wait; the way to end it."""
