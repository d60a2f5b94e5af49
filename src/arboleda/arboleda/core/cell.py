"""One cell at work: its queue, its current task, and the tree that carries the task out."""

from __future__ import annotations

from collections import deque
from enum import Enum
from typing import Protocol

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from . import recipes
from .errors import ArboledaError, IllegalTransition, QueueFull
from .leaves import Make
from .ledger import Entry
from .messages import Failure, Notice, Reason, TaskState
from .model import Cell
from .task import Task

TICK_BOUND = 20  # ticks in one step; more means a tree that never comes to rest


class CellState(str, Enum):
    """Where a cell is, in the words of PackML (ISA-TR88.00.02)."""

    IDLE = "idle"
    EXECUTE = "execute"
    HELD = "held"


class Cause(str, Enum):
    """What moves a cell from one state to another."""

    TASK = "task"
    ENDED = "ended"
    FAILED = "failed"


TABLE: dict[tuple[CellState, Cause], CellState] = {
    (CellState.IDLE, Cause.TASK): CellState.EXECUTE,
    (CellState.EXECUTE, Cause.ENDED): CellState.IDLE,
    (CellState.EXECUTE, Cause.FAILED): CellState.HELD,
}


class Plant(Protocol):
    """What a cell needs of the plant it works in."""

    now: float

    def send(self, make: Make, cell: str, doing: str) -> Entry: ...
    def cancel(self, entry: Entry) -> None: ...
    def cancel_all(self, cell: str) -> None: ...
    def notify(self, notice: Notice) -> None: ...
    def task_changed(self, task: Task) -> None: ...
    def obstacle(self, robot: str) -> Failure | None: ...
    def node(self, robot: str) -> int | None: ...


class CellRun:
    """The moving part of a cell; it is the context of its leaves."""

    def __init__(self, cell: Cell, plant: Plant, dwell_s: float) -> None:
        self.cell = cell
        self.plant = plant
        self.dwell_s = dwell_s
        self.state = CellState.IDLE
        self.queue: deque[Task] = deque()
        self.task: Task | None = None
        self.tree: Behaviour | None = None
        self.dirty = False
        self.closed = False
        self.failure: Failure | None = None
        self.wakes: list[float] = []
        self.sent = 0

    @property
    def now(self) -> float:
        return self.plant.now

    @property
    def next_deadline(self) -> float | None:
        return min(self.wakes, default=None)

    def enqueue(self, task: Task) -> None:
        """Take a task in; QueueFull at the limit."""
        if len(self.queue) >= self.cell.queue_limit:
            text = f"{self.cell.name} has {len(self.queue)} tasks waiting, its limit; send it again later"
            raise QueueFull(text)
        self.queue.append(task)

    def waiting_for(self) -> str | None:
        """Why the next task does not start, for the operator; None where nothing is in its way."""
        if self.closed:
            return "the plant is ending"
        if self.held_by is not None:
            return self.held_by
        if self.state is CellState.EXECUTE:
            return f"{self.cell.name} is busy"
        found = (self.plant.obstacle(robot.name) for robot in self.cell.robots)
        return next((failure.sentence for failure in found if failure), None)

    @property
    def held_by(self) -> str | None:
        """What holds the cell and what to do about it; None where it is not held."""
        if self.state is not CellState.HELD or self.failure is None:
            return None
        return f"{self.cell.name} is held ({self.failure.sentence}); restart the plant once it is safe"

    def advance(self) -> bool:
        """Start what can start and tick until the tree rests; whether anything was ticked."""
        if self.wakes and min(self.wakes) <= self.now:
            self.wakes = [at for at in self.wakes if at > self.now]
            self.dirty = True
        if self.dirty and self.task is not None:
            self._tick(self.task)
        if self.task is None and self.queue and self.waiting_for() is None:
            self._start(self.queue.popleft())
            self.dirty = True
        ticked, self.dirty = self.dirty, False
        return ticked

    def interrupt(self, failure: Failure) -> None:
        """End the running task as failed; whatever moves for it is halted."""
        if self.task is not None:
            self.task.fail(failure)
            self._end(self.task, TaskState.FAILED)

    def close(self) -> None:
        """The plant ends: the running task is interrupted, no other one starts."""
        self.closed = True
        self.interrupt(Failure(reason=Reason.INTERRUPTED, sentence="the plant was asked to end"))

    def _start(self, task: Task) -> None:
        self.task = task
        self._become(Cause.TASK)
        task.become(TaskState.RUNNING, self.now)
        self.plant.task_changed(task)
        self._tick(task)

    def _tick(self, task: Task) -> None:
        try:
            self.tree = self.tree or recipes.build(task.order, self)
            status = self._tick_to_rest(self.tree)
        except Exception as error:  # noqa: BLE001 - a leaf may be user code: it ends its task, not the plant
            sentence = f"{self.cell.name}: {type(error).__name__} in the tree: {error}"
            self.interrupt(Failure(reason=Reason.INTERNAL, sentence=sentence))
            return
        if status is Status.SUCCESS:
            self._end(task, TaskState.DONE)
        elif status is not Status.RUNNING:
            self._end(task, TaskState.FAILED)

    def _tick_to_rest(self, tree: Behaviour) -> Status:
        for _ in range(TICK_BOUND):
            before = self._signature(tree)
            tree.tick_once()
            if tree.status is not Status.RUNNING or self._signature(tree) == before:
                return tree.status
        raise ArboledaError(f"the tree did not come to rest in {TICK_BOUND} ticks")

    def _signature(self, tree: Behaviour) -> tuple[object, ...]:
        return (self.sent, *(node.status for node in tree.iterate()))

    def _end(self, task: Task, state: TaskState) -> None:
        if self.tree is not None:
            self.tree.stop(Status.INVALID)
        self.plant.cancel_all(self.cell.name)  # py_trees does not terminate a leaf that raised
        if state is TaskState.FAILED:
            task.fail(Failure(reason=Reason.INTERNAL, sentence=f"{task.order.text}: failed without a cause"))
        self.task, self.tree, self.wakes, self.failure = None, None, [], task.failure
        self._become(Cause.ENDED if state is TaskState.DONE else Cause.FAILED)
        task.become(state, self.now)
        self.plant.task_changed(task)

    def _become(self, cause: Cause) -> None:
        after = TABLE.get((self.state, cause))
        if after is None:
            raise IllegalTransition(f"cell {self.cell.name} is {self.state.value}: no {cause.value} there")
        self.state = after

    def send(self, make: Make, doing: str) -> Entry:
        self.sent += 1
        return self.plant.send(make, self.cell.name, doing)

    def cancel(self, entry: Entry) -> None:
        self.plant.cancel(entry)

    def node(self) -> int | None:
        return self.plant.node(self.cell.mobile.name)

    def wake_at(self, at: float) -> None:
        self.wakes.append(at)

    def notify(self, notice: Notice) -> None:
        self.plant.notify(notice)

    def fail(self, failure: Failure) -> None:
        if self.task is not None:
            self.task.fail(failure)
