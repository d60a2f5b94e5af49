"""Disk of a simulated plant: commits as in the real store, and the loss of the last ones in a power cut."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field, replace

from arboleda.departures.leaving import MOST_UNSYNCED_S, SYNCED_WITHIN_S
from arboleda.engine import HISTORY, unsettled
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import (
    ENDED,
    Fact,
    Failure,
    Journal,
    KeptTask,
    Notice,
    Remember,
    TaskChanged,
    TaskState,
)

Kept = Remember | Journal | TaskChanged


def is_kept(message: object) -> bool:
    """True if a plant commits this message before it tells anybody."""
    if isinstance(message, TaskChanged):
        return message.state is not TaskState.REFUSED
    return isinstance(message, Remember | Journal)


def is_step(message: object) -> bool:
    """True if the message records which step a task has reached."""
    return isinstance(message, Remember) and message.fact is Fact.STEP


class DiskFull(ArboledaError):
    """Raised when the disk has no room: the message was not kept."""


@dataclass(slots=True)
class Content:
    """Rows on the disk: name to value by kind of fact, and tasks by id in the order of acceptance."""

    facts: dict[Fact, dict[str, str]] = field(default_factory=dict)
    tasks: dict[str, KeptTask] = field(default_factory=dict)

    def take(self, message: Kept, now: float) -> None:
        """Apply a commit; a change of a task to its present state changes nothing, as in the store."""
        if isinstance(message, Remember):
            self._fact(message)
        elif isinstance(message, TaskChanged):
            self._task(message, now)

    def copy(self) -> Content:
        return Content({fact: dict(rows) for fact, rows in self.facts.items()}, dict(self.tasks))

    def _fact(self, order: Remember) -> None:
        rows = self.facts.setdefault(order.fact, {})
        if order.value is None:
            rows.pop(order.name, None)
        else:
            rows[order.name] = order.value

    def _task(self, change: TaskChanged, now: float) -> None:
        row = self.tasks.get(change.task)
        if change.state is TaskState.QUEUED:
            if row is None:
                self.tasks[change.task] = KeptTask(
                    id=change.task,
                    text=change.text,
                    cell=change.cell or "",
                    state=change.state,
                    choice=change.choice,
                )
        elif row is None:
            return
        elif change.state is TaskState.RUNNING:
            if row.started_at is None:
                self.tasks[change.task] = replace(row, state=change.state, started_at=now, attempts=1)
        elif row.ended_at is None:
            failure = Failure(reason=change.reason, sentence=change.sentence) if change.reason else None
            self.tasks[change.task] = replace(
                row,
                state=change.state,
                failure=failure,
                ended_at=now,
                course=change.course,
                unchecked=change.unchecked,
            )


class Disk:
    """Disk: keeps the memory of a plant over its starts.

    What was committed survives the death of the plant's process. A power cut undoes the last commits that
    nothing has synced: a thread does that within SYNCED_WITHIN_S, and `let_command_leave` and `sync` where
    somebody waits for it. Syncing one syncs all before it. Left out is what is for history
    alone: how often a step was tried again, and what was answered to a task that has ended. The recipe of a
    task is left out, too: a next start then expects of a task what that very task took.
    While it is `full`, nothing more is committed; `slow` is how many seconds a sync takes.
    """

    def __init__(self) -> None:
        self._live = Content()
        self._synced = Content()
        self._unsynced: deque[tuple[Kept, float]] = deque()
        # the time of each commit whose sync is not over, and whether it precedes commands
        self._lagging: deque[tuple[float, bool]] = deque()
        self.cuts = 0  # how often the power was cut
        self.full = False
        self.slow: list[float] = []

    @property
    def facts(self) -> dict[Fact, dict[str, str]]:
        """Name to value by kind of fact."""
        return self._live.facts

    @property
    def tasks(self) -> dict[str, KeptTask]:
        """All tasks by id, in the order of acceptance."""
        return self._live.tasks

    def unsynced(self, now: float) -> int:
        """The number of commits that a power cut may undo."""
        over = now - SYNCED_WITHIN_S - self._sync_s
        while self._unsynced and self._unsynced[0][1] <= over:
            self._sync(1)
        return len(self._unsynced)

    def commit(self, message: Notice, now: float, *, precedes_commands: bool = True) -> float:
        """Keep a message if a plant keeps such ones; return the seconds that it takes; raises DiskFull.

        What `precedes_commands` is durable before one leaves.
        """
        if not isinstance(message, Remember | Journal | TaskChanged):
            return 0.0
        if self.full:
            raise DiskFull("database or disk is full")
        self._live.take(message, now)
        self._unsynced.append((message, now))
        self._lagging.append((now, precedes_commands))
        return 0.0

    def let_command_leave(self, now: float) -> float:
        """Sync what has to be durable before a command leaves, if anything; return the seconds it takes."""
        while self._lagging and self._lagging[0][0] <= now - SYNCED_WITHIN_S - self._sync_s:
            self._lagging.popleft()
        waits = [at for at, precedes in self._lagging if precedes or at < now - MOST_UNSYNCED_S]
        if not waits:
            return 0.0
        self._lagging.clear()
        self.sync()
        return max(max(waits) + self._sync_s - now, 0.0)

    def sync(self) -> None:
        """Make all that was committed durable."""
        self._sync(len(self._unsynced))

    @property
    def _sync_s(self) -> float:
        return max(self.slow, default=0.0)

    def cut_power(self, reached: int, now: float) -> None:
        """Undo the unsynced commits, except the first `reached` ones, as the next start finds it."""
        self.cuts += 1
        self._sync(min(reached, self.unsynced(now)))
        self._unsynced.clear()
        self._lagging.clear()
        for change in [*unsettled(self._synced.facts, self._synced.tasks.values())]:
            self._synced.take(change, now)
        self._live = self._synced.copy()

    def found(self) -> Content:
        """The content for a starting plant: all facts, the open tasks, the last HISTORY ended ones."""
        ended = [task.id for task in self.tasks.values() if task.state in ENDED]
        forgotten = set(ended[:-HISTORY])
        found = self._live.copy()
        for id in forgotten:
            del found.tasks[id]
        return found

    def ended(self, id: str) -> KeptTask | None:
        """The task with this id, if it has ended."""
        task = self.tasks.get(id)
        return task if task is not None and task.state in ENDED else None

    def _sync(self, count: int) -> None:
        for _ in range(count):
            self._synced.take(*self._unsynced.popleft())
