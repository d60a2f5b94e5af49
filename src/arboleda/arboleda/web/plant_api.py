"""The plant as the web server sees it: snapshots, and a post for task texts and operators' verbs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any, Protocol

from arboleda.model.facts import Value
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.store.oee_rows import OeeQuery
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.views.oee import Oee

PLANT = "arboleda-plant"  # header by which a client names the plant it means
COMMAND_LINE = "arboleda"  # the User-Agent of our own command, before its version
Snapshot = dict[str, Any]


class PlantApi(Protocol):
    """Plant as the server sees it; no call blocks unless it says so, and all data is plain."""

    def snapshot(self) -> Snapshot:
        """The last stored snapshot; while the plant waits for its disk, the one before."""

    def latest(self) -> Snapshot:
        """The newest snapshot, with everything already answered; waits for the disk, a second at most."""

    def offers(self) -> list[dict[str, Any]]:
        """The recipes of each cell, with their parameters and the values allowed."""

    def spelled(self, *, cell: str, recipe: str, values: Mapping[str, Value], id: str) -> str:
        """The text of a task given by its values; raises TextError if it is no task of this plant."""

    def find(self, task: str) -> dict[str, Any] | None:
        """One task by its id, None if unknown; waits for the disk, a second at most."""

    def history(self, query: TaskQuery) -> list[TaskRow]:
        """Tasks of this and earlier starts; waits for the disk."""

    def oee(self, query: OeeQuery) -> list[Oee]:
        """The OEE of its cells, in the order of the plant file; waits for the disk."""

    def promises(self, text: str) -> list[dict[str, Any]]:
        """The promise of each cell that a task text names; raises TextError or QueueFull."""

    def submit(self, text: str, asked_by: str, choice: str = "") -> Future[dict[str, Any]]:
        """A future of the task. A state `refused` or a TextError in it is the caller's mistake, any other
        ArboledaError means "not now". `choice` is why it was given to its cell, where somebody chose."""

    def operate(self, verb: Verb, scope: str, *, by_hand: bool = False) -> Future[OperatorAnswer]:
        """A future of the outcome of a verb; `scope` is "" for the whole plant."""

    def act(self, number: int) -> dict[str, Any] | None:
        """One of the operators' last acts by its number; None if it is forgotten."""

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        """Call `callback` with each changed snapshot, in the plant's thread, which must not wait.

        Returns a function that ends this.
        """
