"""Where task texts come in: what is accepted, under which id, and what is remembered."""

from __future__ import annotations

from . import text
from .errors import QueueFull, TextError
from .model import PlantModel
from .sentence import Phrase
from .task import Task

ENDING = Phrase("task.plant_ending", "the plant is ending; no new task is taken")
ID_TAKEN = Phrase("task.id_taken", "#{id} is already the id of '{text}'; use another id")
HISTORY = 1000  # tasks remembered by id; ended ones are forgotten first


class Intake:
    """The tasks by id; ids of its own making are `t-<epoch>-<n>`."""

    def __init__(self, model: PlantModel, epoch: int) -> None:
        self.model = model
        self.epoch = epoch
        self.closed = False
        self.tasks: dict[str, Task] = {}
        self._count = 0

    def task(self, words: str) -> Task:
        """The new or already known task of a text; TextError or QueueFull says why there is none."""
        if self.closed:
            raise QueueFull(ENDING())
        order = text.parse(words, self.model)
        known = self.tasks.get(order.id) if order.id else None
        if known is None:
            self._count += 1
            return Task(order.id or f"t-{self.epoch}-{self._count}", order)
        if known.order.text != order.text:
            raise TextError(ID_TAKEN(id=known.id, text=known.order.text))
        return known

    def knows(self, task: Task) -> bool:
        return task.id in self.tasks

    def remember(self, task: Task) -> None:
        """Keep a task by its id; past HISTORY the oldest ended one goes."""
        self.tasks[task.id] = task
        if len(self.tasks) > HISTORY:
            ended = (known.id for known in self.tasks.values() if known.ended_at is not None)
            self.tasks.pop(next(ended, task.id))
