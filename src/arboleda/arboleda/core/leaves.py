"""The few py_trees leaves that every recipe is made of, and the context they share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from .ledger import Entry, State
from .messages import Command, Failure, Notice, Reason
from .model import Cell

Make = Callable[..., Command]  # called with id=<the new command's id>


class Context(Protocol):
    """What a leaf may touch: the step's time, its cell, and ways to send, cancel, wait and fail."""

    cell: Cell
    dwell_s: float

    @property
    def now(self) -> float:
        """The time of this step, s."""

    def send(self, make: Make, doing: str) -> Entry:
        """Send the command that `make(id=...)` returns; an already failed entry where it may not leave."""

    def node(self) -> int | None:
        """Where the cell's mobile robot is known to stand."""

    def cancel(self, entry: Entry) -> None:
        """Halt an open command."""

    def wake_at(self, at: float) -> None:
        """Have the tree ticked again at `at`."""

    def notify(self, notice: Notice) -> None:
        """Tell the outside."""

    def fail(self, failure: Failure) -> None:
        """Name the cause of a failure; the first one named becomes the task's."""


class Act(Behaviour):
    """One command: RUNNING while it is open, SUCCESS when it is done; left early, it is halted."""

    def __init__(self, name: str, context: Context, make: Make, doing: str) -> None:
        super().__init__(name)
        self.context = context
        self.make = make
        self.doing = doing
        self.entry: Entry | None = None

    def initialise(self) -> None:
        self.feedback_message = self.doing
        self.entry = self.context.send(self.make, self.doing)

    def update(self) -> Status:
        if self.entry is None or self.entry.open:
            return Status.RUNNING
        if self.entry.state is State.DONE:
            return Status.SUCCESS
        cancelled = Failure(reason=Reason.CANCELLED, sentence=f"cancelled while {self.doing}")
        failure = self.entry.failure or cancelled
        self.feedback_message = failure.sentence
        self.context.fail(failure)
        return Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        if new_status is Status.INVALID and self.entry is not None and self.entry.open:
            self.context.cancel(self.entry)


class Dwell(Behaviour):
    """Wait a fixed time."""

    def __init__(self, name: str, context: Context, seconds: float) -> None:
        super().__init__(name)
        self.context = context
        self.seconds = seconds
        self.until = 0.0

    def initialise(self) -> None:
        self.until = self.context.now + self.seconds
        self.context.wake_at(self.until)

    def update(self) -> Status:
        return Status.SUCCESS if self.context.now >= self.until else Status.RUNNING


class Announce(Behaviour):
    """Tell the outside once."""

    def __init__(self, name: str, context: Context, notice: Notice) -> None:
        super().__init__(name)
        self.context = context
        self.notice = notice

    def update(self) -> Status:
        self.context.notify(self.notice)
        return Status.SUCCESS


class Require(Behaviour):
    """A condition: SUCCESS where `obstacle()` returns None, else FAILURE with what it returns."""

    def __init__(self, name: str, context: Context, obstacle: Callable[[], Failure | None]) -> None:
        super().__init__(name)
        self.context = context
        self.obstacle = obstacle

    def update(self) -> Status:
        failure = self.obstacle()
        if failure is None:
            return Status.SUCCESS
        self.feedback_message = failure.sentence
        self.context.fail(failure)
        return Status.FAILURE
