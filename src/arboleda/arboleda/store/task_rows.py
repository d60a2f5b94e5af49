"""The tasks that a plant's memory has, and how they are asked for; for whoever only reads, too."""

from __future__ import annotations

import csv
import json
import re
import sqlite3
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import astuple, dataclass, fields
from io import StringIO
from pathlib import Path
from typing import Any, Protocol, TypeVar

from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Check, Course, Reason, TaskAnswer, TaskState
from arboleda.model.outside import quoted
from arboleda.model.sentence import OWN, Sentence, retold

from .memory_file import VERSION, explained, read_only, refuse_damage, refuse_other, refuse_version, version

COMMAND, PAGE, HTTP, ROS, DEMO = "command", "page", "http", "ros2", "demo"  # the ways by which a task comes
ASSISTANT = "assistant"  # one more, whose tasks are bound to what was approved
STATES, REASONS = {state.value for state in TaskState}, {None, *(reason.value for reason in Reason)}


@dataclass(frozen=True, kw_only=True)
class TaskRow:
    """Task as it is stored; times are Unix times, `ended_s` is None while it waits or runs.

    - `number` grows with each task that the plant accepts.
    - `sentence` is the reason of a failure, in English; `said` is the same sentence as JSON.
    - `asked_by` is the way by which the task came, None if unknown.
    - `attempts` is the number of times that it was begun, 0 before, and for tasks older than this column.
    - `answers` is JSON of the answers given while it ran, None for none, or before it has ended.
    - `choice` is JSON of the reason why it is done in its cell, None if no other cell was allowed.
    - `course` is JSON of the times of its steps, None before it is done.
    - `unchecked` are words for those parts of a finished task that nobody confirmed, None for none.
    """

    number: int
    id: str
    text: str
    cell: str
    recipe: str
    state: str
    reason: str | None
    sentence: str | None
    said: str | None
    accepted_s: float
    started_s: float | None
    ended_s: float | None
    asked_by: str | None = None
    attempts: int = 0
    answers: str | None = None
    choice: str | None = None
    course: str | None = None
    unchecked: str | None = None


@dataclass(frozen=True, kw_only=True)
class TaskQuery:
    """Filter for tasks; "" and None set no condition.

    `words`: part of the task text or of its id. `since_s`, `until_s`: the span in which it was accepted, Unix
    time. `before`: only tasks with a lower number, to read the next page.
    """

    id: str = ""
    cell: str = ""
    state: str = ""
    recipe: str = ""
    words: str = ""
    since_s: float | None = None
    until_s: float | None = None
    before: int | None = None
    is_open: bool | None = None
    limit: int | None = 100


WILD = re.compile("[!%_]")  # characters with a meaning in LIKE
COLUMNS = tuple(each.name for each in fields(TaskRow))
KINDS: dict[str, tuple[type, ...]] = {
    "int": (int,),
    "str": (str,),
    "str | None": (str, type(None)),
    "float": (float,),
    "float | None": (float, type(None)),
}
KINDS_OF = {each.name: KINDS[str(each.type)] for each in fields(TaskRow)}
CONDITIONS = {
    "id": "id = ?",
    "cell": "cell = ?",
    "state": "state = ?",
    "recipe": "recipe = ?",
    "since_s": "accepted_s >= ?",
    "until_s": "accepted_s < ?",
    "before": "number < ?",
}


def selection(query: TaskQuery) -> tuple[str, tuple[object, ...]]:
    """The SQL of a query and its values, the last accepted task first."""
    filters = {column: getattr(query, column) for column in CONDITIONS}
    wanted = {column: value for column, value in filters.items() if value not in ("", None)}
    where, values = [CONDITIONS[column] for column in wanted], list(wanted.values())
    if query.is_open is not None:
        where.append("ended_s IS NULL" if query.is_open else "ended_s IS NOT NULL")
    if query.words:  # LIKE is three times as fast as instr(lower())
        where.append("(text LIKE ? ESCAPE '!' OR id LIKE ? ESCAPE '!')")
        values += ["%" + WILD.sub(r"!\g<0>", query.words) + "%"] * 2
    clause = f" WHERE {' AND '.join(where)}" if where else ""
    select = f"SELECT {', '.join(COLUMNS)} FROM task{clause} ORDER BY number DESC"
    if query.limit is None:
        return select, tuple(values)
    return f"{select} LIMIT ?", (*values, query.limit)


def to_row(row: tuple[object, ...]) -> TaskRow:
    """A row of a `selection`; raises ArboledaError if it is damaged."""
    known = dict(zip(COLUMNS, row, strict=True))
    if not all(isinstance(known[name], kinds) for name, kinds in KINDS_OF.items()):
        raise ArboledaError(
            f"The plant's memory says of the task {quoted(known['id'])} what is of another type than it"
            " wrote: put a backup in its place."
        )
    if known["state"] not in STATES or known["reason"] not in REASONS:
        what = f"{quoted(known['id'])} what means nothing"
        raise ArboledaError(f"The plant's memory says of the task {what}: put a backup in its place.")
    return TaskRow(**known)  # type: ignore[arg-type]


def sentence_of(row: TaskRow) -> Sentence:
    """The reason why a task failed; only its stored English if the data cannot be read."""
    try:
        return retold(row.sentence or "", json.loads(row.said or ""))
    except ValueError:
        return OWN(text=row.sentence or "")


def choice_of(row: TaskRow) -> Sentence | None:
    """The reason why a task is done in its cell, if several were allowed; None if it cannot be read."""
    try:
        data = json.loads(row.choice or "null")
        return None if data is None else retold(str(data["english"]), data)
    except (KeyError, TypeError, ValueError):
        return None


def choice_written(choice: Sentence | None) -> str | None:
    """The text under which a choice is stored; `choice_of` reads it."""
    if choice is None:
        return None
    return json.dumps({"english": str(choice), **choice.data()}, ensure_ascii=False)


def course_of(row: TaskRow) -> Course | None:
    """The times of a task's steps, if it is done; None if there are none, or they cannot be read."""
    try:
        course = json.loads(row.course or "null")
        begun = {step: float(at) for step, at in course["begun"].items()}
        return Course(seconds=float(course["seconds"]), begun=begun)
    except (AttributeError, KeyError, TypeError, ValueError):
        return None


def course_written(course: Course | None) -> str | None:
    """The text under which a course is stored; `course_of` reads it."""
    return None if course is None else json.dumps(vars(course), separators=(",", ":"))


def unchecked_of(row: TaskRow) -> tuple[Check, ...]:
    """The checks of a finished task that nobody confirmed; empty if they cannot be read."""
    try:
        return tuple(map(Check, (row.unchecked or "").split()))
    except ValueError:
        return ()


def unchecked_written(checks: Iterable[Check]) -> str | None:
    """The text under which unconfirmed checks are stored; `unchecked_of` reads it."""
    return " ".join(each.value for each in checks) or None


def answers_of(row: TaskRow) -> tuple[TaskAnswer, ...]:
    """The answers that were given while a task ran; empty if they cannot be read."""
    try:
        return tuple(TaskAnswer(**each) for each in json.loads(row.answers or "[]"))
    except (TypeError, ValueError):
        return ()


def table(rows: Iterable[TaskRow], *, names: bool = True) -> str:
    """Rows as comma-separated values, after a line of column names if wanted."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    if names:
        writer.writerow(COLUMNS)
    writer.writerows(astuple(row) for row in rows)
    return text.getvalue()


Answer = TypeVar("Answer")


class Database(Protocol):
    """Database connection that runs a query, with a value for each `?`, and returns its rows."""

    def execute(self, statement: str, values: tuple[object, ...] = ..., /) -> Iterable[tuple[Any, ...]]: ...


class History(ABC):
    """Reads the tasks of a plant, from any thread, while it runs or not; opened when it is first asked."""

    @abstractmethod
    def _reading(self) -> AbstractContextManager[Database | None]:
        """The database, for one thread at a time; None if nothing is stored yet. Raises ArboledaError."""

    @abstractmethod
    def close(self) -> None:
        """Close the history; idempotent."""

    def select(self, query: TaskQuery) -> list[TaskRow]:
        """The tasks of a query, the last accepted first; none if nothing is stored yet."""
        return self.read(lambda db: [to_row(row) for row in db.execute(*selection(query))]) or []

    def read(self, ask: Callable[[Database], Answer]) -> Answer | None:
        """The answer of `ask`, which reads what it needs; None if nothing is stored yet."""
        with self._reading() as db:
            return None if db is None else ask(db)


class TaskHistory(History):
    """Task history in a SQLite file.

    `plant` is the name of its plant, "" if unknown; the memory of another plant is refused. A damaged file is
    refused, too, unless `is_checked`: then its writer has checked it.
    """

    def __init__(self, path: Path, plant: str = "", *, is_checked: bool = False) -> None:
        self._path = path
        self._plant = plant
        self._is_checked = is_checked
        self._lock = threading.Lock()
        self._opened: sqlite3.Connection | None = None

    @contextmanager
    def _reading(self) -> Iterator[Database | None]:
        if not self._path.exists():
            yield None
            return
        with self._lock, explained(self._path, ArboledaError, "cannot be read"):
            yield self._db()

    def close(self) -> None:
        with self._lock:
            if self._opened is not None:
                self._opened.close()
                self._opened = None

    def _db(self) -> sqlite3.Connection:
        if self._opened is None:
            db = read_only(self._path)
            try:
                refuse_version(db, self._path)
                if self._plant:
                    refuse_other(db, self._path, self._plant)
                if version(db) < VERSION:
                    raise ArboledaError(
                        f"The plant's memory {self._path} is of an older Arboleda:"
                        " start the plant once, which brings it up to date."
                    )
                if not self._is_checked:
                    refuse_damage(db)
            except BaseException:  # whatever it is, the file is not left open
                db.close()
                raise
            self._opened = db
        return self._opened
