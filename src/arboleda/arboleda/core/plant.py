"""The plant: `Plant.step(now, events) -> commands and notices` is where all state changes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

from . import text
from .cell import CellRun
from .dispatcher import Dispatcher
from .errors import QueueFull, TextError
from .intake import Intake
from .leaves import Make
from .ledger import Entry
from .messages import (
    Command,
    Event,
    Failure,
    Heartbeat,
    Notice,
    Report,
    Shutdown,
    TaskChanged,
    TaskRequest,
    TaskState,
    Undelivered,
)
from .model import PlantModel
from .task import Task

HEARTBEAT_S = 0.25


class Plant:
    """All cells of a plant; `epoch` names this start and must be higher than any before."""

    def __init__(self, model: PlantModel, *, epoch: int, now: float) -> None:
        self.model = model
        self.epoch = epoch
        self.now = now
        self.intake = Intake(model, epoch)
        self.dispatcher = Dispatcher(model, epoch)
        self.cells = {cell.name: CellRun(cell, self, model.timing.dwell_s) for cell in model.cells}
        self._changes = 0
        self._next_beat = now
        self._earliest = now

    def step(self, now: float, events: Iterable[Event]) -> list[Command | Notice]:
        """Take in `events` in order, then deadlines up to `now` (s, never decreasing); what must go out."""
        self.now = now
        for event in events:
            self._expire(math.nextafter(event.at, -math.inf))
            HANDLERS[type(event)](self, event)
        self._expire(now)
        for cell in self.cells.values():
            cell.dirty = cell.dirty or cell.cell.name in self.dispatcher.ledger.changed
        self.dispatcher.ledger.changed.clear()
        for cell in self.cells.values():
            self._changes += cell.advance()
        self._beat()
        self._earliest = self.next_deadline
        out, self.dispatcher.outbox = self.dispatcher.outbox, []
        return out

    @property
    def next_deadline(self) -> float:
        """When `step` is due again without any event, s."""
        cells = [cell.next_deadline for cell in self.cells.values()]
        due = [self._next_beat, self.dispatcher.next_deadline, *cells]
        return min(at for at in due if at is not None)

    @property
    def version(self) -> int:
        """A number that changes whenever something other than a position changed."""
        return self.dispatcher.version + self._changes

    @property
    def at_rest(self) -> bool:
        """Whether no task runs and no command is open."""
        return not self.dispatcher.ledger.entries and all(cell.task is None for cell in self.cells.values())

    def sleepers(self) -> list[str]:
        """Cells whose task runs with nothing left to wake its tree; anything here is a defect."""
        awake = {entry.cell for entry in self.dispatcher.ledger.entries.values()}
        runs = [cell for cell in self.cells.values() if cell.task is not None and not cell.wakes]
        return [cell.cell.name for cell in runs if cell.cell.name not in awake]

    def send(self, make: Make, cell: str, doing: str) -> Entry:
        return self.dispatcher.send(make, cell, doing, self.now)

    def cancel(self, entry: Entry) -> None:
        self.dispatcher.cancel(entry, self.now)

    def cancel_all(self, cell: str) -> None:
        """Halt what is still under way for a cell."""
        self.dispatcher.cancel_all(cell, self.now)

    def obstacle(self, robot: str) -> Failure | None:
        return self.dispatcher.beliefs[robot].obstacle()

    def node(self, robot: str) -> int | None:
        return self.dispatcher.beliefs[robot].known_node

    def notify(self, notice: Notice) -> None:
        self.dispatcher.outbox.append(notice)

    def task_changed(self, task: Task, request: str | None = None) -> None:
        """Announce the state a task is in."""
        self._changes += 1
        sentence = self.cells[task.order.cell].waiting_for() if task.state is TaskState.QUEUED else None
        change = TaskChanged(
            task=task.id,
            text=task.order.text,
            cell=task.order.cell,
            state=task.state,
            reason=task.failure.reason if task.failure else None,
            sentence=task.failure.sentence if task.failure else sentence or "",
            request=request,
        )
        self.notify(change)

    def _expire(self, limit: float) -> None:
        if limit >= self._earliest:
            self.dispatcher.expire(limit, self.now)

    def _beat(self) -> None:
        if self.now >= self._next_beat:
            self._next_beat = self.now + HEARTBEAT_S
            self.notify(Heartbeat(epoch=self.epoch))

    def _on_report(self, report: Report) -> None:
        self.dispatcher.report(report, self.now)

    def _on_undelivered(self, event: Undelivered) -> None:
        self.dispatcher.undelivered(event.id, event.robot, event.sentence, self.now)

    def _on_task_request(self, request: TaskRequest) -> None:
        try:
            task = self.intake.task(request.text, self.now)
            if not self.intake.knows(task):
                self.cells[task.order.cell].enqueue(task)
                self.intake.remember(task)
        except (TextError, QueueFull) as refusal:
            self.notify(_refused(request, str(refusal)))
            return
        self.task_changed(task, request.request)

    def _on_shutdown(self, event: Shutdown) -> None:
        self.intake.closed = True
        for cell in self.cells.values():
            cell.close()


def _refused(request: TaskRequest, sentence: str) -> TaskChanged:
    return TaskChanged(
        task="",
        text=request.text[: text.LONGEST],
        cell=None,
        state=TaskState.REFUSED,
        sentence=sentence,
        request=request.request,
    )


HANDLERS: dict[type, Callable[[Plant, Any], None]] = {
    Report: Plant._on_report,
    TaskRequest: Plant._on_task_request,
    Undelivered: Plant._on_undelivered,
    Shutdown: Plant._on_shutdown,
}
