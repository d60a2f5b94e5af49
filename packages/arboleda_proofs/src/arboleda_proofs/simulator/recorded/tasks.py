"""Every task by what the plant said of it: `TaskChanged`, in order.

`each_task_ends_once` finds by it a task of which it is told twice that it ended.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from arboleda.engine import HISTORY
from arboleda.engine.inspection import UNCHECKED
from arboleda.model.messages import KeptTask, TaskChanged, TaskState
from arboleda.model.sentence import NOTHING

SURE = 500  # accepted tasks back to which the plant remembers every one
KEPT = HISTORY  # ended tasks that are remembered: the plant may remember as many
OPEN = frozenset({TaskState.QUEUED, TaskState.RUNNING})


@dataclass(slots=True)
class KnownTask:
    """A task that was accepted; `number` counts the accepted ones; `cancelled`: an operator has cancelled it,
    None if that may have meant this task.

    `message` is the last word on it; `accepted` is when it first came, `began` when it was told to run,
    `announced` when its tree told that it starts, which a tree of people need not.
    """

    id: str
    cell: str
    number: int
    state: TaskState
    since: float
    message: TaskChanged
    accepted: float
    cancelled: bool | None = False
    began: float | None = None
    announced: float | None = None


@dataclass(slots=True)
class Change:
    """A word of the plant on a task, and the state before; `answer`: it only repeats itself on request.

    `first` is the task that was first in the queue of its cell.
    """

    message: TaskChanged
    before: TaskState | None
    answer: bool
    first: str | None
    cancelled: bool | None


class Tasks:
    """Open and lately ended tasks, by id; the queue and the running task of each cell, by id."""

    def __init__(self, cells: Iterable[str]) -> None:
        self.open: dict[str, KnownTask] = {}
        self.ended: OrderedDict[str, KnownTask] = OrderedDict()
        self.queues: dict[str, dict[str, KnownTask]] = {cell: {} for cell in cells}
        self.running: dict[str, str] = {}
        self.changes: list[Change] = []
        self.refused = 0  # in this step
        self._accepted = 0

    def restart(self, kept: Iterable[KeptTask], now: float) -> None:
        """Begin a start of the plant with these tasks; of some of them nobody may have been told."""
        before = self.open
        self.open = {}
        self.running.clear()
        for queue in self.queues.values():
            queue.clear()
        for row in kept:
            if row.id not in self.ended:
                self._take_back(row, before.get(row.id), now)

    def _take_back(self, row: KeptTask, task: KnownTask | None, now: float) -> None:
        if task is None:
            self._accepted += 1
            task = KnownTask(row.id, row.cell, self._accepted, row.state, now, _last_change(row), now)
        if task.state is not row.state:
            task.message = _last_change(row)
        task.state, task.began = row.state, row.started_at
        if row.state is TaskState.RUNNING and task.cancelled:
            task.cancelled = None  # the plant that was to halt it is gone
        task.since = row.ended_at or row.started_at or task.since
        if row.ended_at is not None:
            self._keep(task)
            return
        self.open[task.id] = task
        if row.state is TaskState.QUEUED:
            self.queues[task.cell][task.id] = task
        else:
            self.running[task.cell] = task.id

    def clear_news(self) -> None:
        self.changes.clear()
        self.refused = 0

    def known(self, id: str) -> KnownTask | None:
        """The task with this id, unless the plant may have forgotten it and given the id anew."""
        task = self.open.get(id) or self.ended.get(id)
        return task if task is not None and task.number > self._accepted - SURE else self.open.get(id)

    def of_cell(self, cell: str) -> list[KnownTask]:
        """Ended and open tasks of a cell, the oldest first."""
        known = (*self.ended.values(), *self.open.values())
        return sorted((task for task in known if task.cell == cell), key=lambda task: task.number)

    def take(self, change: TaskChanged, now: float, *, is_repeated: bool) -> None:
        """Take in the plant's word on a task; `is_repeated`: it may be a mere answer to a request."""
        if change.state is TaskState.REFUSED or change.cell is None:
            self.refused += 1
            return
        task = self.known(change.task) or self._answered(change, is_repeated=is_repeated)
        before = task.state if task else None
        answer = is_repeated and before is change.state
        first = next(iter(self.queues[change.cell]), None)
        self.changes.append(Change(change, before, answer, first, task.cancelled if task else False))
        if not answer:
            self._follow(change, task, now)

    def cancel(self, scope: str, cells: Sequence[str]) -> list[str]:
        """Take in a cancel: of a task by its id, or of what runs in each of the cells of the scope and could
        be cancelled. Return the cells of which it is known that their task is cancelled.
        """
        task = self.known(scope.strip().lstrip("#"))
        if task is not None:
            task.cancelled = True
            return [task.cell]
        for name in cells:
            running = self.open.get(self.running.get(name, ""))
            if running is not None and running.cancelled is False:
                running.cancelled = True if len(cells) == 1 else None
        return list(cells) if len(cells) == 1 else []

    def may_be_cancelled(self, scope: str, cells: Iterable[str]) -> None:
        """Take in a cancel, of a task by its id or in these cells, that may or may not have been kept."""
        named = self.known(scope.strip().lstrip("#"))
        running = (self.running.get(name, "") for name in cells)
        for task in [named] if named is not None else [self.open.get(id) for id in running]:
            if task is not None and task.cancelled is False:
                task.cancelled = None

    def announce(self, cell: str, now: float) -> None:
        """Take in that the tree of a cell's task tells that it starts."""
        if (task := self.open.get(self.running.get(cell, ""))) is not None:
            task.announced = now

    def _answered(self, change: TaskChanged, *, is_repeated: bool) -> KnownTask | None:
        """The ended task that this word only repeats, as an answer to a repeated request; None for news."""
        task = self.ended.get(change.task) if is_repeated else None
        return task if task is not None and task.state is change.state else None

    def _follow(self, change: TaskChanged, task: KnownTask | None, now: float) -> None:
        if task is None or change.state is TaskState.QUEUED:
            self._accepted += 1
            task = KnownTask(change.task, change.cell or "", self._accepted, change.state, now, change, now)
        task.state, task.since, task.message = change.state, now, change
        task.began = now if change.state is TaskState.RUNNING else task.began
        queue = self.queues[task.cell]
        queue.pop(task.id, None)
        self.open.pop(task.id, None)
        if self.running.get(task.cell) == task.id:
            del self.running[task.cell]
        if change.state in OPEN:
            self.open[task.id] = task
            if change.state is TaskState.QUEUED:
                queue[task.id] = task
            else:
                self.running[task.cell] = task.id
        else:
            self._keep(task)

    def _keep(self, task: KnownTask) -> None:
        self.ended[task.id] = task
        if len(self.ended) > KEPT:
            self.ended.popitem(last=False)


def _last_change(row: KeptTask) -> TaskChanged:
    """The last word on a task that would have been told, from its row on the disk."""
    remark = UNCHECKED[row.unchecked]() if row.unchecked else NOTHING
    return TaskChanged(
        task=row.id,
        text=row.text,
        cell=row.cell,
        state=row.state,
        reason=row.failure.reason if row.failure else None,
        sentence=row.failure.sentence if row.failure else remark,
    )
