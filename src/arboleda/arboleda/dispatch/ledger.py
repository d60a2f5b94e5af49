"""Ledger of the commands that were sent: their states by one table, and their deadlines."""

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

from .stillness import ReportMoment


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
"""The states of a command that has not ended."""
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
    """Observations in the reports since a command was sent."""

    def __init__(self) -> None:
        self.moving = False
        self.stopped_since: float | None = None  # since when every state code says stopped
        self.on_goal_since: float | None = None  # since when every report of its goal shows the goal
        self.place: Position | None = None
        self.passed = -1  # the index of the last of its positions that reports show
        self.unhomed = False
        self.ended: str | None = None  # the command that the robot last named as done


class Entry:
    """Life of one command; times in s of the plant's clock; `doing` reads as "moving home"."""

    def __init__(
        self, command: Command, *, cell: str, doing: Sentence, sent_at: float, deadline: float
    ) -> None:
        self.command = command
        self.cell = cell
        self.doing = doing
        self.sent_at = sent_at
        self.deadline = deadline
        self.origin: Position | None = None  # where its robot was believed to be when it left
        self.settles_at: float | None = None
        self.settled = False  # True: it counts as done without a report, as its time was over
        self.must_be_named = False  # True: only its id proves it, as a fact may be from before
        self.was_sent = True  # False: its robot was not ready for it
        self.too_early = False  # True: it was not sent because its robot was still moving
        self.state = State.SENT
        self.accepted_at: float | None = None
        self.is_abandoned = False  # True: nobody waits for its end
        self.cancelled_at: float | None = None
        self.cancelled_after = ReportMoment(0, -math.inf)
        self.failure: Failure | None = None
        self.interference: Sentence | None = None  # the last command of somebody else meanwhile
        self.observations = Observations()
        self.rule: Callable[..., Any] | None = None  # the rule that proves it, looked up once
        self.answer: Value | None = None  # to a query
        self.before: Receipt | None = None  # the receipt of its board when it left
        self.number: tuple[int, int] | None = None  # given by its board, once accepted
        self.is_work = isinstance(command, Work)
        self.halts = isinstance(command, Work) and command.on_stop is OnStop.HALT
        self.finishes = self.is_work and not self.halts  # it goes on to its end, even when it is cancelled
        self.positions = command.way if isinstance(command, Motion) else ()
        self.sets = command.sets

    @property
    def open(self) -> bool:
        return self.state in OPEN

    @property
    def next_deadline(self) -> float:
        return self.deadline if self.settles_at is None else min(self.deadline, self.settles_at)

    def refuse(self, failure: Failure, *, too_early: bool = False) -> None:
        """End a command that is not sent; no ledger may open it."""
        self.state, self.failure, self.was_sent, self.too_early = State.FAILED, failure, False, too_early


class Ledger:
    """The open commands by id; `changed` has the cells that have to look at theirs again.

    `version` grows with each change that screens show, but for positions. `last_sent` and `last_work` have
    the last command and the last work of each robot, without stops and halts.
    """

    def __init__(self) -> None:
        self.entries: dict[str, Entry] = {}
        self.by_robot: defaultdict[str, list[Entry]] = defaultdict(
            list
        )  # lists are replaced: loops over them feed the ledger
        self.by_cell: defaultdict[str, list[Entry]] = defaultdict(list)
        self._due: dict[str, float] = {}
        self.next_deadline = math.inf  # of all open commands, s of the plant's clock
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
        """The open work of a robot."""
        for entry in self.by_robot[robot]:
            if entry.is_work:
                return entry
        return None

    def finishes(self, robot: str) -> bool:
        """True while a robot does work that goes on to its end even when it is stopped."""
        work = self.work_of(robot)
        return work is not None and work.finishes

    def question(self, robot: str) -> Entry | None:
        """The open question to a person; None where nobody asks anything, and for a robot."""
        questions = (e for e in self.by_robot[robot] if isinstance(e.command, Question) and e.open)
        return next(questions, None)

    def of_cell(self, cell: str) -> list[Entry]:
        """The open commands of a cell, oldest first."""
        return self.by_cell[cell]

    def feed(self, id: str, feed: Feed, now: float, failure: Failure | None = None) -> None:
        """Apply a feed; the feed of an unknown or ended command is counted and ignored."""
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
        for table, key in ((self.by_robot, robot), (self.by_cell, cell)):
            table[key] = table[key].copy()
            table[key].remove(entry)
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
