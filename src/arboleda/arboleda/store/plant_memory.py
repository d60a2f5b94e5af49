"""The port of a plant's memory: what must survive a restart, as rows that every store takes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import AbstractContextManager, nullcontext
from typing import Any, TypeVar

from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Fact, Remember, outlives_power

from .act_table import ActTable
from .lead import Lead
from .rows import Statement, row_of_fact
from .task_table import TaskTable
from .time_table import TimeTable

CLOCK = ("host", "clock")  # the row that names the setting of a clock after which times were last moved
Memory = TypeVar("Memory", bound="PlantMemory")


class PlantMemory(ABC):
    """The memory of a plant, between `open` and `close` or as `with` does it; one thread at a time.

    What a method wrote survives a killed process once the method has returned. It survives a power cut after
    `sync`, which any thread may call: all of it but what the rules of `outlives_power` let go.
    ArboledaError says in one sentence what is wrong, and what to do.
    """

    name: str  # its name in sentences
    remedy: str  # advice for a damaged memory
    timing: AbstractContextManager[None] = nullcontext()  # around whatever waits for the disk
    may_lack_writes = False  # whether a power cut may have undone the last writes of the start before

    def __init__(self) -> None:
        self.tasks = TaskTable(self)
        self.acts = ActTable(self)
        self.times = TimeTable(self)
        self.lead = Lead()

    @abstractmethod
    def open(self) -> None:
        """Open the memory, or make a new one; raises StartError. Idempotent."""

    @abstractmethod
    def close(self) -> None:
        """Close the memory; idempotent."""

    @abstractmethod
    def write(self, *statements: Statement, durable: bool) -> None:
        """Commit all of the statements, or none; what is to be `durable` may wait for `sync`."""

    @abstractmethod
    def sync(self) -> None:
        """Make durable what was written; callable from any thread."""

    def fold(self) -> None:  # noqa: B027 - a server does that by itself
        """Put in order what has been written for a while; for one thread, which may have to wait."""

    @abstractmethod
    def read(self, statement: str, *values: object) -> list[tuple[Any, ...]]:
        """The rows of a query."""

    @abstractmethod
    def damaged(self) -> ArboledaError:
        """The error for a row that is not as it was written."""

    def confirm(self) -> None:  # noqa: B027
        """Make sure that this process still leads, and that what it wrote can be found again; ArboledaError.
        Costs next to nothing while that is known."""

    def look(self) -> None:
        """Do what `confirm` does, and look for what other programs have written; from any thread."""
        self.confirm()

    def keep(self, *facts: Remember) -> None:
        """Commit facts, and forget those whose value is None: all of them, or none."""
        last_words = {(fact.fact, fact.name): fact for fact in facts}.values()
        durable = any(outlives_power(fact) for fact in facts)
        self.write(*map(_kept, last_words), durable=durable)

    def note(self, *facts: Remember) -> None:
        """Write facts that may be committed later, by `settle` or with what is written next. They survive a
        killed process at once.
        """
        self.keep(*facts)

    def settle(self) -> None:  # noqa: B027 - a memory that notes nothing has nothing to commit
        """Commit what was noted."""

    def begin(self, *facts: Remember) -> None:
        """Commit what a start changes of what the one before has left, once it knows how that ended."""
        if facts:
            self.keep(*facts)

    def move_times(self, by_s: float, now_s: float, since_ran_s: float, started_ago_s: float) -> None:
        """Move the times of a start, whose wall clock was set by so much and says `now_s`.

        It began `started_ago_s` before, when the plant had run for `since_ran_s`.
        """
        setting = repr(now_s)  # a database may get a statement again whose answer was lost
        until_s = now_s - by_s
        of_tasks = self.tasks.moved(by_s, since_ran_s, until_s - started_ago_s, until_s)
        moves = (of_tasks, *self.times.moved(by_s))
        once = " AND NOT EXISTS (SELECT 1 FROM fact WHERE fact = ? AND name = ? AND value = ?)"
        rows = ((text + once, (*values, *CLOCK, setting)) for text, values in moves)
        self.write(*rows, row_of_fact(CLOCK, setting), durable=False)

    def facts(self, fact: Fact) -> dict[str, str]:
        """The stored facts: value by name."""
        rows = self.read("SELECT name, value FROM fact WHERE fact = ? ORDER BY name", fact.value)
        if not all(isinstance(each, str) for row in rows for each in row):
            raise self.damaged()
        return dict(rows)

    def __enter__(self: Memory) -> Memory:
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _kept(fact: Remember) -> Statement:
    return row_of_fact((fact.fact.value, fact.name), fact.value)
