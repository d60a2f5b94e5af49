"""The port of a plant's memory: what must survive a restart, as statements of SQL that every store takes."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Any, TypeVar

from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import (
    Fact,
    Journal,
    Remember,
    TaskAnswer,
    TaskChanged,
    TaskState,
    outlives_power,
)

from .task_rows import (
    TaskQuery,
    TaskRow,
    choice_written,
    course_written,
    selection,
    to_row,
    unchecked_written,
)

PUT_TO_WORK = "put_to_work"  # in the journal in place of a verb
PRUNED = 20  # ended tasks forgotten with each new end: more than come in, and quickly done
Statement = tuple[str, tuple[object, ...]]  # with its values, each in the place of a `?`
Memory = TypeVar("Memory", bound="PlantMemory")


class Superseded(ArboledaError):
    """Error: another process leads this plant now; this one must neither write nor send anything more."""


class OtherLeader(StartError):
    """Error: another process leads this plant, and is alive."""


@dataclass(frozen=True, kw_only=True)
class JournalEntry:
    """Act of an operator; `id` grows, `unix_s` is the time by the clock of the plant's machine.

    `cell` is None if the act was for more than one, or is older than this column; `said` is JSON of the
    sentence, None if it is older than that column.
    """

    id: int
    unix_s: float
    verb: str
    scope: str
    sentence: str
    cell: str | None
    said: str | None


@dataclass(frozen=True, kw_only=True)
class Standby:
    """Process that waits to lead the plant: its host, and its page, "" if it gave none."""

    host: str
    url: str


class PlantMemory(ABC):
    """The memory of a plant, between `open` and `close` or as `with` does it; one thread at a time.

    What a method wrote survives a killed process once the method has returned. It survives a power cut after
    `sync`, which any thread may call: all of it but what the rules of `outlives_power` let go.
    ArboledaError says in one sentence what is wrong, and what to do.
    """

    name: str  # its name in sentences
    remedy: str  # advice for a damaged memory
    standbys: Sequence[Standby] = ()  # processes that wait to lead, as of the last renewal
    going: Sequence[str] = ()  # cells that the last leader held only for the change
    timing: AbstractContextManager[None] = nullcontext()  # around whatever waits for the disk
    may_lack_writes = False  # whether a power cut may have undone the last writes of the start before
    renew_s: float | None = None  # period of calls of `renew` while the plant is led; None: never

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
    def _damaged(self) -> ArboledaError:
        """The error for a row that is not as it was written."""

    def lead(self, epoch: int) -> int:
        """Take the lead under `epoch`, or a higher number if the memory knows higher ones; returns the
        number.

        Raises StartError if another process leads.
        """
        return epoch

    def renew(self) -> bool:
        """Renew the lead; True if another process is wanted as the leader.

        Called in one thread of its own. Raises Superseded, or ArboledaError if the memory cannot be reached.
        """
        return False

    def own_address(self) -> str:
        """The address by which hosts that reach the memory may reach this one, "" if unknown.

        Callable from any thread; raises ArboledaError.
        """
        return ""

    def announce(self, url: str) -> None:  # noqa: B027 - a file is read on this machine only
        """Store the address of the plant's page; callable from any thread, raises ArboledaError."""

    def hand_over(self, going: Sequence[str]) -> None:  # noqa: B027
        """Store for the next leader the cells that are held for the change only.

        Callable from any thread; raises ArboledaError.
        """

    def confirm(self) -> None:  # noqa: B027
        """Make sure that this process still leads, and that what it wrote can be found again; ArboledaError.
        Costs next to nothing while that is known."""

    @property
    def leads_for_certain(self) -> bool:
        """True while this process is known to lead, without asking the server; callable from any thread."""
        return True

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

    def facts(self, fact: Fact) -> dict[str, str]:
        """The stored facts: value by name."""
        rows = self.read("SELECT name, value FROM fact WHERE fact = ? ORDER BY name", fact.value)
        if not all(isinstance(each, str) for row in rows for each in row):
            raise self._damaged()
        return dict(rows)

    def journal(self, entry: Journal, unix_s: float) -> None:
        """Commit one act of an operator."""
        sentence_json = json.dumps(entry.sentence.data(), ensure_ascii=False)
        word = PUT_TO_WORK if entry.verb is None else entry.verb.value
        row = (unix_s, word, entry.scope, str(entry.sentence), entry.cell, sentence_json)
        insert = "INSERT INTO journal (unix_s, verb, scope, sentence, cell, said) VALUES (?, ?, ?, ?, ?, ?)"
        self.write((insert, row), durable=outlives_power(entry))

    def task(
        self,
        change: TaskChanged,
        recipe: str,
        unix_s: float,
        asked_by: str | None = None,
        answers: Sequence[TaskAnswer] = (),
    ) -> None:
        """Commit one change of a task; what is known already, as when it is asked for again, stays.

        `answers` are kept with its end.
        """
        state, durable = change.state, outlives_power(change)
        if state is TaskState.QUEUED:
            words = (change.task, change.text, change.cell, recipe, state.value)
            row = (*words, unix_s, asked_by, choice_written(change.choice))
            columns = "id, text, cell, recipe, state, accepted_s, asked_by, choice"
            values = ", ".join("?" * len(row))
            insert = f"INSERT INTO task ({columns}) VALUES ({values}) ON CONFLICT (id) DO NOTHING"
            self.write((insert, row), durable=durable)
        elif state is TaskState.RUNNING:
            begin = (
                "UPDATE task SET state = ?, started_s = ?, attempts = 1 WHERE id = ? AND started_s IS NULL"
            )
            self.write((begin, (state.value, unix_s, change.task)), durable=durable)
        elif state is not TaskState.REFUSED:
            sentence_json = json.dumps(change.sentence.data(), ensure_ascii=False)
            reason = None if change.reason is None else change.reason.value
            end = (
                "UPDATE task SET state = ?, reason = ?, sentence = ?, said = ?, ended_s = ?, answers = ?,"
                " course = ?, unchecked = ? WHERE id = ? AND ended_s IS NULL"
            )
            answers_json = (
                json.dumps([vars(each) for each in answers], ensure_ascii=False) if answers else None
            )
            how, unchecked = course_written(change.course), unchecked_written(change.unchecked)
            outcome = (state.value, reason, str(change.sentence), sentence_json, unix_s)
            self.write((end, (*outcome, answers_json, how, unchecked, change.task)), durable=durable)

    def attempted(self, task: str, attempts: int) -> None:
        """Commit the number of times that a task was begun."""
        self.write(("UPDATE task SET attempts = ? WHERE id = ?", (attempts, task)), durable=False)

    def forget_tasks(self, before_unix_s: float) -> None:
        """Forget the oldest tasks that ended before a time, at most PRUNED of them."""
        oldest = "SELECT number FROM task WHERE ended_s < ? ORDER BY ended_s LIMIT ?"
        delete = f"DELETE FROM task WHERE number IN ({oldest})"
        self.write((delete, (before_unix_s, PRUNED)), durable=False)

    def began(self, unix_s: float, before_unix_s: float) -> None:
        """Commit that the plant runs, and forget downtimes that ended long ago."""
        last = "SELECT seen_s FROM run WHERE number = (SELECT max(number) FROM run) AND seen_s > down.since_s"
        for statement in (
            (f"UPDATE down SET until_s = coalesce(({last}), since_s) WHERE until_s IS NULL", ()),
            ("DELETE FROM down WHERE until_s < ?", (before_unix_s,)),
            ("DELETE FROM run WHERE seen_s < ?", (before_unix_s,)),
            ("INSERT INTO run (since_s, seen_s, ended) VALUES (?, ?, 0)", (unix_s, unix_s)),
        ):
            self.write(statement, durable=False)

    def note_run(self, unix_s: float, *, ended: bool = False) -> None:
        """Commit that the plant still runs, or that it was ended."""
        last = "number = (SELECT max(number) FROM run)"
        update = f"UPDATE run SET seen_s = ?, ended = ? WHERE {last}"
        self.write((update, (unix_s, int(ended))), durable=False)

    def stands(self, cell: str, state: str | None, unix_s: float) -> None:
        """Commit that a cell does no work from now on, in this state; None: it works again."""
        over = "UPDATE down SET until_s = ? WHERE cell = ? AND until_s IS NULL"
        self.write((over, (unix_s, cell)), durable=False)
        if state is not None:
            begun = "INSERT INTO down (cell, state, since_s) VALUES (?, ?, ?)"
            self.write((begun, (cell, state, unix_s)), durable=False)

    def tasks(self, query: TaskQuery) -> list[TaskRow]:
        """The tasks that a query asks for, the last accepted first."""
        statement, values = selection(query)
        return [to_row(row) for row in self.read(statement, *values)]

    def entries(self, limit: int = 100) -> list[JournalEntry]:
        """The last acts, the newest first."""
        columns = "id", "unix_s", "verb", "scope", "sentence", "cell", "said"
        rows = self.read(f"SELECT {', '.join(columns)} FROM journal ORDER BY id DESC LIMIT ?", limit)
        for _, unix_s, *texts, cell, sentence_json in rows:
            known = [*texts, cell or "", sentence_json or ""]
            if not isinstance(unix_s, float) or not all(isinstance(text, str) for text in known):
                raise self._damaged()
        return [JournalEntry(**dict(zip(columns, row, strict=True))) for row in rows]

    def __enter__(self: Memory) -> Memory:
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _kept(fact: Remember) -> Statement:
    return row_of_fact((fact.fact.value, fact.name), fact.value)


def row_of_fact(key: tuple[str, str], value: str | None) -> Statement:
    """The statement that writes a row of `fact`, or deletes it."""
    if value is None:
        return "DELETE FROM fact WHERE fact = ? AND name = ?", key
    insert = "INSERT INTO fact (fact, name, value) VALUES (?, ?, ?)"
    return f"{insert} ON CONFLICT (fact, name) DO UPDATE SET value = excluded.value", (*key, value)
