"""Every command the plant sent: id -> state, by one table, with deadlines."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable
from enum import Enum
from typing import Any

from arboleda.model.commands import Command, Motion, OnStop, Position, Question, Work
from arboleda.model.errors import IllegalTransition
from arboleda.model.facts import Value
from arboleda.model.messages import Failure, Receipt
from arboleda.model.sentence import Sentence

from .stillness import Moment


class State(str, Enum):
    """The life of a command."""

    SENT = "sent"
    RUNNING = "running"
    CANCELLING = "cancelling"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


class Feed(str, Enum):
    """Event of a command's life; HALTED is an end by halt or stop."""

    ACCEPTED = "accepted"
    REJECTED = "rejected"
    DONE = "done"
    FAILED = "failed"
    HALTED = "halted"
    CANCEL = "cancel"


OPEN = frozenset({State.SENT, State.RUNNING, State.CANCELLING})
TABLE: dict[tuple[State, Feed], State] = {
    (State.SENT, Feed.ACCEPTED): State.RUNNING,
    (State.SENT, Feed.REJECTED): State.FAILED,
    (State.SENT, Feed.DONE): State.DONE,
    (State.SENT, Feed.FAILED): State.FAILED,
    (State.SENT, Feed.HALTED): State.FAILED,
    (State.SENT, Feed.CANCEL): State.CANCELLING,
    (State.RUNNING, Feed.ACCEPTED): State.RUNNING,
    (State.RUNNING, Feed.REJECTED): State.FAILED,
    (State.RUNNING, Feed.DONE): State.DONE,
    (State.RUNNING, Feed.FAILED): State.FAILED,
    (State.RUNNING, Feed.HALTED): State.FAILED,
    (State.RUNNING, Feed.CANCEL): State.CANCELLING,
    (State.CANCELLING, Feed.ACCEPTED): State.CANCELLING,
    (State.CANCELLING, Feed.REJECTED): State.CANCELLED,
    (State.CANCELLING, Feed.DONE): State.DONE,
    (State.CANCELLING, Feed.FAILED): State.FAILED,
    (State.CANCELLING, Feed.HALTED): State.CANCELLED,
    (State.CANCELLING, Feed.CANCEL): State.CANCELLING,
}


class Observations:
    """Observations since a command was sent, from reports."""

    def __init__(self) -> None:
        self.moving = False
        self.stopped_since: float | None = None  # since when its state code says stopped, without a break
        self.on_goal_since: float | None = None  # since when all that it reports of its goal is the goal
        self.place: Position | None = None
        self.passed = -1  # up to which position of its way the reported ones show that it has come
        self.unhomed = False
        self.ended: str | None = None  # the command that was named last as done


class Entry:
    """One command's life; times in s of the plant's clock; `doing` is said as "moving home"."""

    def __init__(
        self, command: Command, *, cell: str, doing: Sentence, sent_at: float, deadline: float
    ) -> None:
        self.command = command
        self.cell = cell
        self.doing = doing
        self.sent_at = sent_at
        self.deadline = deadline
        self.origin: Position | None = None  # where its robot was believed to stand then
        self.settles_at: float | None = None
        self.settled = False  # it counts as done because its time was over: nothing was reported of it
        self.must_be_named = False  # a board proves it by its id only: a fact may be from before
        self.left = True  # False: its robot was not ready for it
        self.too_early = False  # it never left, because its robot was still moving
        self.state = State.SENT
        self.accepted_at: float | None = None
        self.is_abandoned = False  # nobody waits for its end any more
        self.cancelled_at: float | None = None
        self.cancelled_after = Moment(0, -math.inf)
        self.failure: Failure | None = None
        self.interference: Sentence | None = None  # the last command of somebody else meanwhile
        self.observations = Observations()
        self.rule: Callable[..., Any] | None = None  # what proves it, once it was looked up
        self.answer: Value | None = None  # to a query
        self.before: Receipt | None = None  # what its board said of numbers when it left
        self.number: tuple[int, int] | None = None  # its own, once its board has named it as accepted
        self.is_work = isinstance(command, Work)
        self.halts = isinstance(command, Work) and command.on_stop is OnStop.HALT
        self.finishes = self.is_work and not self.halts  # whoever stops waiting for it
        self.way = command.way if isinstance(command, Motion) else ()
        self.sets = command.sets

    @property
    def open(self) -> bool:
        return self.state in OPEN

    @property
    def next_deadline(self) -> float:
        return self.deadline if self.settles_at is None else min(self.deadline, self.settles_at)

    def refuse(self, failure: Failure, *, too_early: bool = False) -> None:
        """End a command that never left: it must not be opened in a ledger."""
        self.state, self.failure, self.left, self.too_early = State.FAILED, failure, False, too_early


class Ledger:
    """The open commands by id, and which cells must look again.

    `version` changes whenever something changed to which screens react: all but positions. `last_sent` and
    `last_work` have each robot's last command, and its last work; stops and halts are no commands here.
    """

    def __init__(self) -> None:
        self.entries: dict[str, Entry] = {}
        self.by_robot: defaultdict[str, list[Entry]] = defaultdict(list)  # new lists: readers feed meanwhile
        self.by_cell: defaultdict[str, list[Entry]] = defaultdict(list)  # the same
        self._due: dict[str, float] = {}
        self.next_deadline = math.inf  # when a command is due, s of the plant's clock; inf where none is
        self.changed: set[str] = set()
        self.version = 0
        self.last_sent: dict[str, Entry] = {}
        self.last_work: dict[str, Entry] = {}
        self.ignored: Counter[str] = Counter()

    def open(self, entry: Entry) -> None:
        robot = entry.command.robot
        self.entries[entry.command.id] = entry
        self.by_robot[robot] = [*self.by_robot[robot], entry]
        self.by_cell[entry.cell] = [*self.by_cell[entry.cell], entry]
        self.last_sent[robot] = entry
        if entry.is_work:
            self.last_work[robot] = entry
        self.plan(entry)

    def plan(self, entry: Entry) -> None:
        """Take over an open command's deadline."""
        id, due = entry.command.id, entry.next_deadline
        before, self._due[id] = self._due.get(id), due
        if due <= self.next_deadline:
            self.next_deadline = due
        elif before == self.next_deadline:
            self.next_deadline = min(self._due.values())

    def of_robot(self, robot: str) -> list[Entry]:
        """The open commands of a robot, oldest first."""
        return self.by_robot[robot]

    def work_of(self, robot: str) -> Entry | None:
        """The work of a robot that has not ended."""
        for entry in self.by_robot[robot]:
            if entry.is_work:
                return entry
        return None

    def finishes(self, robot: str) -> bool:
        """True while a robot does work that goes on even when it is stopped, until it is finished."""
        work = self.work_of(robot)
        return work is not None and work.finishes

    def question(self, robot: str) -> Entry | None:
        """The open question to a person; None where there is none, or this is no person."""
        questions = (e for e in self.by_robot[robot] if isinstance(e.command, Question) and e.open)
        return next(questions, None)

    def of_cell(self, cell: str) -> list[Entry]:
        """The open commands of a cell, oldest first."""
        return self.by_cell[cell]

    def feed(self, id: str, feed: Feed, now: float, failure: Failure | None = None) -> None:
        """Apply one feed; an unknown or finished id is counted and ignored."""
        entry = self.entries.get(id)
        if entry is None:
            self.ignored[feed.value] += 1
            return
        self._apply(entry, feed, now)
        if entry.state is State.FAILED:
            entry.failure = failure
        if not entry.open:
            self._close(entry)

    def _close(self, entry: Entry) -> None:
        id, robot, cell = entry.command.id, entry.command.robot, entry.cell
        del self.entries[id]
        self.by_robot[robot] = [each for each in self.by_robot[robot] if each is not entry]
        self.by_cell[cell] = [each for each in self.by_cell[cell] if each is not entry]
        if self._due.pop(id) == self.next_deadline:
            self.next_deadline = min(self._due.values(), default=math.inf)

    def _apply(self, entry: Entry, feed: Feed, now: float) -> None:
        after = TABLE.get((entry.state, feed))
        if after is None:
            what = f"command {entry.command.id} is {entry.state.value}"
            raise IllegalTransition(f"{what}: no {feed.value} there")
        if after is not entry.state:
            self.changed.add(entry.cell)
        entry.state = after
        if feed is Feed.ACCEPTED and entry.accepted_at is None:
            entry.accepted_at = now
        if feed is Feed.CANCEL and entry.cancelled_at is None:
            entry.cancelled_at = now
