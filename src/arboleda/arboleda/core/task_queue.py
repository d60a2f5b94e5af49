"""Queue of one cell: the tasks that wait, at most as many as its plant file allows."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from arboleda.model.errors import QueueFull
from arboleda.model.messages import Failure, TaskState
from arboleda.model.plant_model import Cell
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Task
from arboleda.trees.cell_time import CellTime

FULL = Phrase("cell.full", "{cell} has {number:,} tasks waiting, its limit; send it again later")
FULL_OF_ONE = Phrase("cell.full_of_one", "{cell} has {number} task waiting, its limit; send it again later")
PAUSED = Phrase("cell.queue_paused", "the queue of {cell} is paused; resume {cell} starts it")
LEFT_OVER = Phrase(
    "cell.left_over", "{number:,} tasks of an earlier start wait in {cell}; resume {cell} starts them"
)
LEFT_OVER_ONE = Phrase(
    "cell.left_over_one", "{number} task of an earlier start waits in {cell}; resume {cell} starts it"
)


class TaskQueue(deque[Task]):
    """Tasks in the order of acceptance. None starts while the queue is `paused`.

    `left_over`: it is paused since tasks of an earlier start wait, and nobody said `resume` yet.
    `awaits_restart`: none starts before the plant starts anew. `changed(task)` hears of dropped tasks.
    """

    def __init__(self, cell: Cell, time: CellTime, changed: Callable[[Task], None]) -> None:
        super().__init__()
        self.paused = False
        self.left_over = False
        self.awaits_restart = False
        self._cell = cell
        self._time = time
        self._changed = changed

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on; tasks that wait stay, also above its limit."""
        self._cell = cell

    @property
    def is_full(self) -> bool:
        """True where no further task has room."""
        return len(self) >= self._cell.queue_limit

    @property
    def why_paused(self) -> Sentence:
        """The sentence that says why no task starts while the queue is paused."""
        if self.left_over and self:
            one_or_more = LEFT_OVER_ONE if len(self) == 1 else LEFT_OVER
            return one_or_more(cell=self._cell.name, number=len(self))
        return PAUSED(cell=self._cell.name)

    def in_its_own_cycle(self, running: Task | None) -> str | None:
        """The robot whose own cycle keeps start signals away while this task runs or others wait, if any."""
        recipes = {task.order.recipe for task in (running, *self) if task is not None}
        alone = (each.alone for each in self._cell.recipes if each.alone and each.name in recipes)
        robots = (self._cell.roles[role] for role in alone)
        return next((robot.name for robot in robots if not robot.queue_triggers), None)

    def add(self, task: Task) -> None:
        """Take a task in; QueueFull at the limit."""
        if self.is_full:
            full = FULL_OF_ONE if len(self) == 1 else FULL
            raise QueueFull(full(cell=self._cell.name, number=len(self)))
        self.append(task)

    def drop(self, task: Task, failure: Failure) -> None:
        """Take a task out; it is cancelled."""
        self.remove(task)
        task.fail(failure)
        task.become(TaskState.CANCELLED, self._time.plant_now)
        self._changed(task)

    def take_back(self, waiting: Sequence[Task], *, cut_off: bool) -> None:
        """Take the tasks that waited here when an earlier start ended, also above the limit.

        They start once somebody says `resume`; at once where the plant file says so and none was cut off.
        """
        self.extend(waiting)
        if waiting and (cut_off or not self._cell.goes_on):
            self.paused = self.left_over = True

    def resume(self) -> None:
        """Let the tasks start."""
        self.paused = self.left_over = False
