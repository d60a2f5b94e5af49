"""Intake of task texts: accepts them under an id, and remembers them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from arboleda.model import text as task_text
from arboleda.model.errors import QueueFull, TextError
from arboleda.model.messages import Failure, KeptTask, Reason, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order, Task

ENDING = Phrase("task.plant_ending", "the plant is ending; no new task is taken")
ID_TAKEN = Phrase("task.id_taken", "#{id} is already the id of '{text}'; use another id")
GONE = Phrase("task.gone", "the plant as it is now does not take it: {why}")
OTHER_WORK = Phrase("task.other_work", "'{text}' would now be other work, by {recipe}")
OTHER_VERSION = Phrase(
    "task.other_version", "it was allowed for another version of the plant than the one at work"
)
OTHER_START = Phrase(
    "task.other_start",
    "it was allowed in an earlier start of the plant and had not begun; it has to be asked for again",
)
CUT_OFF = Phrase(
    "task.cut_off",
    "the plant ended while this was at work; nobody knows how far it came, so it is not done again",
)
Choose = Callable[[Sequence[Order]], tuple[Order, Sentence]]
"""Chooses one of the orders that a text allows, and says why."""
HISTORY = 1000
"""Tasks that a plant remembers by id; more where more wait, since it forgets only ended tasks."""


class Intake:
    """The tasks by id; ids of its own making are `t-<epoch>-<n>`."""

    def __init__(self, model: PlantModel, epoch: int) -> None:
        self.model = model
        self.epoch = epoch
        self.put_last = ""  # the digest of the version that was put to work last, in this start
        self.closed = False
        self.tasks: dict[str, Task] = {}
        self._count = 0

    def task(self, text: str, choose: Choose) -> Task:
        """The task of a text: a new one, or that with its id; TextError or QueueFull says why there is none.

        `choose` is called where the text of a new task names several cells.
        """
        orders = self.orders(text)
        id = orders[0].id
        earlier = self.tasks.get(id) if id else None
        if earlier is None:
            self._count += 1
            order, choice = choose(orders) if len(orders) > 1 else (orders[0], None)
            return Task(id or f"t-{self.epoch}-{self._count}", order, choice)
        if not any(earlier.order.is_alike(order) for order in orders):
            raise TextError(ID_TAKEN(id=earlier.id, text=earlier.order.text))
        return earlier

    def orders(self, text: str) -> Sequence[Order]:
        """The orders that a text allows; TextError or QueueFull says why there is none."""
        if self.closed:
            raise QueueFull(ENDING())
        return task_text.alternatives(text, self.model)

    def take_back(self, record: KeptTask, now: float) -> Task:
        """The task of an earlier start, under its id; cancelled if it waits and this plant cannot do it."""
        task = Task.of(record)
        if record.ended_at is None:
            try:
                task = Task.of(record, task_text.parse(record.text, self.model))
                if record.is_bound and record.state is TaskState.QUEUED:
                    raise TextError(OTHER_START())
            except TextError as error:
                if record.state is TaskState.QUEUED:
                    task.fail(gone(error.sentence))
                    task.become(TaskState.CANCELLED, now)
        self.remember(task)
        return task

    def read_again(self, order: Order) -> Order:
        """The order in the plant of now; TextError where its text means nothing there, or other work."""
        read = task_text.parse(order.text, self.model)
        if read.recipe != order.recipe or [*read.values] != [*order.values]:
            raise TextError(OTHER_WORK(text=order.text, recipe=read.recipe))
        return read

    def still_allowed(self, task: Task, version: str) -> Order:
        """The order of a task that waits, read again; TextError too where another version allowed it."""
        if task.version not in ("", version):
            raise TextError(OTHER_VERSION())
        return self.read_again(task.order)

    def recall(self, record: KeptTask) -> None:
        """Remember a task that ended so long ago that only the store has it."""
        if record.id not in self.tasks and record.ended_at is not None:
            self.remember(Task.of(record))

    def knows(self, task: Task) -> bool:
        return task.id in self.tasks

    def remember(self, task: Task) -> None:
        """Keep a task by its id; past HISTORY the oldest ended one goes, where there is one."""
        self.tasks[task.id] = task
        if len(self.tasks) > HISTORY:
            ended = (task.id for task in self.tasks.values() if task.ended_at is not None)
            self.tasks.pop(next(ended, ""), None)


def gone(why: Sentence) -> Failure:
    """The failure of a task that waited, and that the plant does not take any more."""
    return Failure(reason=Reason.PRECONDITION, sentence=GONE(why=why))
