"""The plant as the web server sees it: snapshots, and a post for task texts and operators' verbs."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any, Protocol, TypeVar

from arboleda.engine import Plant
from arboleda.model.facts import Value
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.text import spelled
from arboleda.model.verbs import Arguments
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.views import forms, view

from .offers import Thing

Snapshot = dict[str, Any]
Found = TypeVar("Found")


class PlantApi(Protocol):
    """Plant as the server sees it; no call blocks unless it says so, and all data is plain.

    What is only looked up in the plant is done here, by `read`; who serves a plant brings the rest.
    """

    @property
    @abstractmethod
    def model(self) -> PlantModel:
        """The model of the plant now; each cell as it works."""

    @abstractmethod
    def read(self, look: Callable[[Plant], Found]) -> Found:
        """`look(plant)` between two steps; it changes nothing."""

    @abstractmethod
    def snapshot(self) -> Snapshot:
        """The last stored snapshot; while the plant waits for its disk, the one before."""

    @abstractmethod
    def latest(self) -> Snapshot:
        """The newest snapshot, with everything already answered; waits for the disk, a second at most."""

    def offers(self) -> list[dict[str, Any]]:
        """The recipes of each cell, with their parameters and the values allowed."""
        return forms.offers(self.model)

    def spelled(self, *, cell: str, recipe: str, values: Mapping[str, Value], id: str) -> str:
        """The text of a task given by its values; raises TextError if it is no task of this plant."""
        return spelled(self.model, cell=cell, recipe=recipe, values=values, id=id)

    def ask(self, kind: type[Thing]) -> Thing | None:
        """The thing of a kind, as `DraftApi`, that a part of this process offers; None where no part does."""
        return None

    @abstractmethod
    def find(self, task: str) -> dict[str, Any] | None:
        """One task by its id, None if unknown; waits for the disk, a second at most."""

    @abstractmethod
    def history(self, query: TaskQuery) -> list[TaskRow]:
        """Tasks of this and earlier starts; waits for the disk."""

    def promises(self, text: str) -> list[dict[str, Any]]:
        """The promise of each cell that a task text names; raises TextError or QueueFull."""
        return self.read(lambda plant: view.promises(plant, text))

    @abstractmethod
    def submit(self, text: str, asked_by: str, choice: str = "") -> Future[dict[str, Any]]:
        """A future of the task. A state `refused` or a TextError in it is the caller's mistake, any other
        ArboledaError means "not now". `choice` is why it was given to its cell, where somebody chose."""

    @abstractmethod
    def operate(
        self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        """A future of the outcome of a verb with its arguments; `scope` is "" for the whole plant."""

    def act(self, number: int) -> dict[str, Any] | None:
        """One of the operators' last acts by its number; None if it is forgotten."""
        return self.read(lambda plant: view.act_by_number(plant, number))

    @abstractmethod
    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        """Call `callback` with each changed snapshot, in the plant's thread, which must not wait.

        Returns a function that ends this.
        """
