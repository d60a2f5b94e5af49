"""Tasks of assistants: only of recipes whose content a person approved, within the plant file's limits."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NoAnswerYet
from datetime import datetime
from typing import Any, Protocol

from arboleda.drivers import plain, quoted
from arboleda.engine import Plant
from arboleda.engine.inspection import intake_of, tasks_of
from arboleda.extension import ArboledaError
from arboleda.model.assistants import Assistants
from arboleda.model.plant_model import PlantModel
from arboleda.recipes import Order
from arboleda.store.task_rows import ASSISTANT, TaskQuery, TaskRow
from arboleda.web.plant_api import Found
from arboleda_make.drafts.api import DraftRefused, State

from ..versions.desk import VersionDesk
from .shelf import Decision, Shelf, Stage

ANSWER_S = 5.0
LEVEL = "the plant file does not let assistants give tasks (`assistants: {level}`)"
NO_CELL = "assistants give no tasks to {cell}; the plant file names {cells}"
NOT_APPROVED = "nobody has approved {recipe} as it is at work; propose it (`recipes: [{recipe}]`) to people"
TOO_MANY = "{count} tasks of assistants are open, and the plant file allows {most} at once"
NOT_NOW = "assistants give tasks from {hours} (it is {now}, by the clock of the plant)"
NO_ANSWER = "the plant did not answer in time; look for the task before you give it again"
WHY = "given by {by}; the recipe was approved by {person} as {hash}"


class Giving(Protocol):
    """Port to the plant: reads it between two steps, and gives it a task."""

    @property
    def model(self) -> PlantModel: ...
    def read(self, look: Callable[[Plant], Found]) -> Found: ...
    def history(self, query: TaskQuery) -> list[TaskRow]: ...
    def submit(self, text: str, asked_by: str, choice: str, version: str) -> Future[dict[str, Any]]: ...


class AssistantTasks:
    """AssistantTasks: judges and gives one task at a time, for threads of a server.

    `clock()` is the time of the plant's host.
    """

    def __init__(
        self,
        shelf: Shelf,
        plant: Giving,
        versions: VersionDesk,
        clock: Callable[[], datetime] = datetime.now,
    ) -> None:
        self._shelf = shelf
        self._plant = plant
        self._versions = versions
        self._clock = clock
        self._turns = threading.Lock()

    def submit(self, text: str, by: str) -> State:
        """The task as the plant took it, refused or not; DraftRefused where an assistant may not give it.

        The plant begins it only by the version for which it was judged, whatever comes in between.
        """
        with self._turns:
            self._must_be_let()
            version = self._versions.at_work().digest
            orders, is_known = self._plant.read(lambda plant: _orders(plant, text))
            approvals = [self._approval(each, version) for each in orders]
            if not is_known:  # whose answer was lost may ask again
                self._must_be_few()
            hash, decision = approvals[0]
            why = WHY.format(by=quoted(by), person=plain(decision.by), hash=hash[:12])
            try:
                return self._plant.submit(text, ASSISTANT, why, version).result(ANSWER_S)
            except NoAnswerYet as error:
                raise ArboledaError(NO_ANSWER) from error

    def _must_be_let(self) -> None:
        level, limits, now = (
            self._plant.model.assistants,
            self._plant.model.assistant_limits,
            self._clock(),
        )
        if level is not Assistants.SUBMIT:
            raise DraftRefused(LEVEL.format(level=level.value))
        if limits.hours is not None and not limits.hours.include(now.hour * 60 + now.minute):
            raise DraftRefused(NOT_NOW.format(hours=limits.hours.text, now=now.strftime("%H:%M")))

    def _approval(self, order: Order, version: str) -> tuple[str, Decision]:
        """Hash and decision of the proposal by which a recipe is approved as it is at work."""
        cells = self._plant.model.assistant_limits.cells
        if order.cell not in cells:
            raise DraftRefused(NO_CELL.format(cell=plain(order.cell), cells=", ".join(cells)))
        for proposal, decision in self._shelf.all():
            is_approved = decision.stage is Stage.APPROVED and decision.content == version
            if is_approved and order.recipe in proposal.recipes:
                return proposal.hash, decision
        raise DraftRefused(NOT_APPROVED.format(recipe=plain(order.recipe)))

    def _must_be_few(self) -> None:
        rows = self._plant.history(TaskQuery(is_open=True, limit=None))
        count, most = (
            sum(each.asked_by == ASSISTANT for each in rows),
            self._plant.model.assistant_limits.at_once,
        )
        if count >= most:
            raise DraftRefused(TOO_MANY.format(count=count, most=most))


def _orders(plant: Plant, text: str) -> tuple[Sequence[Order], bool]:
    """The orders that a text allows, and whether the plant has a task of its id already."""
    orders = intake_of(plant).orders(text)
    return orders, orders[0].id in tasks_of(plant)
