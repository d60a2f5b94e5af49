"""PlantApi of the plant in this process, for its HTTP server and its page."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from arboleda.engine import Plant
from arboleda.model.errors import QueueFull
from arboleda.model.messages import Event, OperatorAnswer, TaskChanged, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.verbs import Arguments
from arboleda.store.task_rows import History, TaskQuery, TaskRow
from arboleda.views import view
from arboleda.web.offers import Offers, Thing
from arboleda.web.plant_api import Found, PlantApi, Snapshot

from ..extensions.questions import Questions as PackageQuestions
from .orchestrator import Orchestrator
from .screens import GLANCE_S

LOG = logging.getLogger(__name__)


class LocalPlant(PlantApi):
    """PlantApi of the plant in this process: its orchestrator, the history of its tasks, and
    what its parts offer."""

    def __init__(self, plant: Orchestrator, history: History, offers: Offers | None = None) -> None:
        self._plant = plant
        self._history = history
        self._offers = offers or Offers()
        self._watchers: tuple[Callable[[Snapshot], None], ...] = ()
        self._changing = threading.Lock()

    @property
    def model(self) -> PlantModel:
        return self._plant.plant.model

    def read(self, look: Callable[[Plant], Found]) -> Found:
        return self._plant.loop.read(look)

    def snapshot(self) -> Snapshot:
        return self._plant.screens.snapshot(GLANCE_S)

    def latest(self) -> Snapshot:
        return self._plant.screens.snapshot()

    def ask(self, kind: type[Thing]) -> Thing | None:
        return self._offers.ask(kind)

    def post(self, event: Event) -> None:
        self._plant.hear(event)

    def find(self, task: str) -> dict[str, Any] | None:
        return self._plant.screens.find(task)

    def history(self, query: TaskQuery) -> list[TaskRow]:
        return self._history.select(query)

    def submit(self, text: str, asked_by: str, choice: str = "", version: str = "") -> Future[dict[str, Any]]:
        plain: Future[dict[str, Any]] = Future()
        answer = self._plant.submit(text, asked_by, choice, version)
        answer.add_done_callback(lambda each: _pass_on(each, plain))
        return plain

    def operate(
        self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        questions = self._offers.ask(PackageQuestions) if verb is Verb.ANSWER else None
        if questions is not None and questions.has(scope, arguments):
            return questions.give(scope, arguments)
        return self._plant.operate(verb, scope, by_hand=by_hand, arguments=arguments)

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        with self._changing:
            self._watchers = (*self._watchers, callback)
        return lambda: self._forget(callback)

    def saw(self, snapshot: Snapshot) -> None:
        """Tell every watcher, in the plant's thread; one that fails is told no more."""
        for callback in self._watchers:
            try:
                callback(snapshot)
            except Exception as error:  # noqa: BLE001 - whatever a screen does, the plant goes on
                LOG.error("a watcher of the plant failed and is told no more: %r", error)
                self._forget(callback)

    def _forget(self, callback: Callable[[Snapshot], None]) -> None:
        with self._changing:
            self._watchers = tuple(each for each in self._watchers if each is not callback)


def _pass_on(answer: Future[TaskChanged], plain: Future[dict[str, Any]]) -> None:
    error = answer.exception()
    if error is not None:
        plain.set_exception(error)
    elif answer.result().for_now:
        plain.set_exception(QueueFull(answer.result().sentence))
    else:
        plain.set_result(view.change(answer.result()))
