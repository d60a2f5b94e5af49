"""Desk for tasks: accepts or refuses requests, and tells of each change of a task."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.model.cell_states import CellState
from arboleda.model.errors import QueueFull, TextError
from arboleda.model.messages import (
    Fact,
    Failure,
    InternalError,
    KeptTask,
    Reason,
    TaskChanged,
    TaskRequest,
    TaskState,
)
from arboleda.model.outside import plain
from arboleda.model.sentence import OWN, Phrase, Sentence
from arboleda.model.task import Order, Task

from . import reasons
from .choosing import PastTimes, Prospect, best, prospect
from .intake import CUT_OFF, OTHER_VERSION
from .plant_state import PlantState

DEFECT = Phrase("plant.defect", "this failed on an internal error; the log has its details")
OWN_CYCLE = Phrase("cell.own_cycle", "{arm} is in its own cycle; its plant file refuses a trigger then")


class TaskDesk:
    def __init__(self, state: PlantState) -> None:
        self._state = state

    def take_back(self, records: Iterable[KeptTask]) -> None:
        """Queue the tasks that waited when an earlier start ended, and hold those at work at their steps."""
        now, memory = self._state.clock.now, self._state.dispatcher.memory
        tasks = [(each.state, self._state.intake.take_back(each, now)) for each in records]
        for name, run in self._state.cells.items():
            own = [task for _, task in tasks if task.order.cell == name]
            waiting = [task for task in own if task.state is TaskState.QUEUED]
            at_work = [task for task in own if task.state is TaskState.RUNNING]
            run.queue.take_back(waiting, cut_off=bool(at_work))
            for task in at_work:
                trail = memory.value(Fact.STEP, task.id)
                if trail is not None and run.task is None and run.state is CellState.IDLE:
                    run.take_up(task, trail)
        at_work_here = {run.task for run in self._state.cells.values()}
        for was, task in tasks:
            if task.state is TaskState.RUNNING and task not in at_work_here:
                task.fail(Failure(reason=Reason.INTERRUPTED, sentence=CUT_OFF()))
                task.become(TaskState.FAILED, now)
            if task.state is not was:
                self.tell(task)
        for id in memory.names(Fact.STEP) - {task.id for task in at_work_here if task}:
            memory.remember(Fact.STEP, id, None)

    def take(self, request: TaskRequest) -> None:
        """Accept a request for a task, or refuse it."""
        try:
            if request.kept is not None:
                self._state.intake.recall(request.kept)
            task = self._state.intake.task(request.text, lambda orders: best(self.prospects(orders)))
            if not self._state.intake.knows(task):
                if request.version and self._state.intake.put_last not in ("", request.version):
                    raise TextError(OTHER_VERSION())
                task.version = request.version
                if request.choice and task.choice is None:
                    task.choice = OWN(text=plain(request.choice))
                self._refuse_trigger(request, task)
                self._state.cells[task.order.cell].queue.add(task)
                self._state.news.touched.add(task.order.cell)
                self._state.news.revised.add(task.order.cell)
                self._state.intake.remember(task)
        except (TextError, QueueFull) as refusal:
            for_now = isinstance(refusal, QueueFull)
            self._state.dispatcher.outbox.append(_refused(request, refusal.sentence, for_now=for_now))
            return
        except Exception as error:  # noqa: BLE001 - whoever asks gets an answer, and the plant goes on
            self._state.dispatcher.outbox += [
                _refused(request, DEFECT()),
                InternalError(cell="", error=error),
            ]
            return
        self.tell(task, request.request)

    def tell(self, task: Task, request: str | None = None) -> None:
        self._state.news.changes += 1
        sentence = (
            reasons.of_waiting(self._state.cells[task.order.cell]) if task.state is TaskState.QUEUED else None
        )
        change = TaskChanged(
            task=task.id,
            text=task.order.text,
            cell=task.order.cell,
            state=task.state,
            reason=task.failure.reason if task.failure else None,
            sentence=sentence or task.remark,
            request=request,
            choice=task.choice,
            course=task.course,
            unchecked=task.unchecked,
        )
        self._state.dispatcher.outbox.append(change)
        if task.ended_at is not None:
            self._state.dispatcher.memory.remember(Fact.STEP, task.id, None)

    def prospects(self, orders: Iterable[Order]) -> list[Prospect]:
        """The promises of the cells that may carry out one of these orders."""
        times = PastTimes(self._state.intake.tasks.values())
        return [
            prospect(order, self._state.cells[order.cell], times, self._state.clock.now) for order in orders
        ]

    def _refuse_trigger(self, request: TaskRequest, task: Task) -> None:
        """Raise QueueFull for a machine's start signal that the cell does not take now."""
        cell = self._state.cells[task.order.cell]
        busy = cell.queue.in_its_own_cycle(cell.task) if request.trigger else None
        if busy is not None:
            raise QueueFull(OWN_CYCLE(arm=busy))


def _refused(request: TaskRequest, sentence: Sentence, *, for_now: bool = False) -> TaskChanged:
    return TaskChanged(
        task="",
        text=plain(request.text),
        cell=None,
        state=TaskState.REFUSED,
        sentence=sentence,
        request=request.request,
        for_now=for_now,
    )
