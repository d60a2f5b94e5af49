"""The plant that runs, as a part of a package sees it."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from arboleda.client.answers.tasks import Done, Task
from arboleda.client.reading import read
from arboleda.model.errors import Refused
from arboleda.model.facts import Value
from arboleda.model.messages import OperatorAnswer, TaskChanged, TaskState
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import Sentence, explained
from arboleda.model.verbs import Verb
from arboleda.views import view
from arboleda.views.alarms import AlarmLevel
from arboleda.web.plant_api import PlantApi

from .alarms import PackageAlarms, RaisedAlarm
from .chapters import Chapters
from .questions import Questions
from .table import Table
from .telling import Answer, Telling

Found = TypeVar("Found")
Given = TypeVar("Given")
Snapshot = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Device:
    """Device of the plant, a robot or anything else.

    `cells` are those that have it, several where they share it. `driver` is its name in the plant file, ""
    for a board on MQTT; `settings` is that driver's dataclass, None where it has none. `facts` are what it
    reported last, by name.
    """

    name: str
    kind: str
    cells: tuple[str, ...]
    driver: str
    settings: object
    facts: Mapping[str, Value]


@dataclass(frozen=True, kw_only=True)
class Uses:
    """Uses that a part makes of the plant it is in, by the functions that do it.

    `package` is the name of the package, which people see. `tell_tasks` and `tell_views` have a function
    called with what is new. `table` makes the table of a name, `folder` the folder of the package.
    """

    package: str
    side: PlantApi
    telling: Telling
    alarms: PackageAlarms
    questions: Questions
    chapters: Chapters
    tell_tasks: Callable[[Callable[[TaskChanged], None]], object]
    tell_views: Callable[[Callable[[Snapshot], None]], object]
    table: Callable[[str], Table]
    folder: Callable[[], Path]


class Plant:
    """Plant in which a part runs. Any thread may use it, and no call changes anything but what it says.

    `extension` is the name under which the package registers the part: it stands beside the tasks that the
    part gives.
    """

    def __init__(self, extension: str, uses: Uses) -> None:
        self.extension = extension
        self._uses = uses
        self._shown: dict[str, Any] = {}
        self._showing = threading.Lock()

    @property
    def name(self) -> str:
        """The name of the plant in its file."""
        return self._uses.side.model.name

    @property
    def cells(self) -> tuple[str, ...]:
        """The names of its cells, in the order of the file."""
        return tuple(cell.name for cell in self._uses.side.model.cells)

    def submit(self, text: str) -> Future[Task]:
        """Ask for a task as it is written on the command line, `cell values #id`.

        The future has the task as the plant keeps it: queued, or refused with the reason. It raises
        ArboledaError where the plant does not take it now, as while its queue is full. Two tasks of one id
        are one task.
        """
        return self._then(self._uses.side.submit(text, f"extension {self.extension}"), _task)

    def submit_form(
        self, *, cell: str, recipe: str, values: Mapping[str, Value] | None = None, id: str = ""
    ) -> Future[Task]:
        """Ask for a task by its recipe and values; raises ArboledaError where there is no such task."""
        side = self._uses.side
        return self.submit(side.spelled(cell=cell, recipe=recipe, values=values or {}, id=id))

    def cancel(self, task: str) -> Future[Done]:
        """Cancel a task that waits or runs, by its id; the future raises Refused where it cannot be."""
        return self.operate(Verb.CANCEL, task)

    def operate(
        self, verb: Verb | str, scope: str = "", *, by_hand: bool = False, **arguments: int | str
    ) -> Future[Done]:
        """Have the plant (no scope), a cell, robot, zone or task carry out an operator's verb.

        The future raises Refused where the plant does not do it now. Raises ValueError for another word.
        """
        answer = self._uses.side.operate(
            Verb(verb), scope, by_hand=by_hand, arguments=tuple(arguments.items())
        )
        return self._then(answer, _done)

    def tasks(self) -> list[Task]:
        """The open tasks and those that ended last, in the order of their acceptance; waits for the disk."""
        return [_task(each) for each in self.snapshot()["tasks"]]

    def task(self, id: str) -> Task | None:
        """A task of this start by its id; None where the plant does not know it; waits for the disk."""
        found = self._uses.side.find(id)
        return None if found is None else _task(found)

    def snapshot(self) -> Snapshot:
        """The whole plant as `GET /api/plant` has it; waits for the disk."""
        return self._uses.side.latest()

    def devices(self) -> dict[str, Device]:
        """The devices by name, in the order of the file, with what they reported last; waits for the disk."""
        rows = {each["name"]: each for each in self.snapshot()["robots"]}
        model = self._uses.side.model
        cells = {name: tuple(cell.name for cell in those) for name, those in model.cells_of.items()}
        return {
            name: _device(robot, cells[name], rows[name]["facts"])
            for name, robot in model.robots.items()
            if name in rows
        }

    def on_task(self, listener: Callable[[Task], object]) -> None:
        """Have a function called with each change of a task, in order, in a thread of this part.

        What is told is kept for good, and told once: a part that is killed before it hears of something is
        not told of it after the restart. A task that is refused is told, too. A listener that raises is left
        out.
        """
        tell, waiting = self._uses.telling.each(listener), set[str]()

        def changed(change: TaskChanged) -> None:
            if not _is_repeated(change, waiting):
                tell(_task(view.change(change)))

        self._uses.tell_tasks(changed)

    def on_change(self, listener: Callable[[Snapshot], object]) -> None:
        """Have a function called with snapshots, in the same thread; a slow one gets the latest."""
        self._uses.tell_views(self._uses.telling.latest(listener))

    def alarm(
        self, sentence: str | Sentence, *, cell: str = "", level: AlarmLevel | str = AlarmLevel.WARNING
    ) -> RaisedAlarm:
        """Tell people of something until `end` of what this returns; a restart ends it, too.

        `level` is `warning`, or `error` where somebody is needed. The same alarm is not raised twice. Raises
        ValueError without a sentence, for another level, and for a cell that there is not.
        """
        if cell and cell not in self.cells:
            raise ValueError(f"there is no cell {cell}; there are {', '.join(self.cells)}")
        return self._uses.alarms.add(
            self._uses.package, sentence, cell=cell, level=level, part=self.extension
        )

    def ask(self, question: str, answers: Iterable[str] = ("yes", "no")) -> Future[str]:
        """Ask people, who answer on the page, by `arboleda answer` or over HTTP.

        The future has one of the answers. It waits as long as nobody answers: `cancel` takes the question
        back, and the end of the plant does. Its callbacks are called in the thread of this part. Raises
        ValueError without a text, or without answers that differ, and ArboledaError where 20 questions of the
        package are open.
        """
        tell = self._uses.telling.each
        return self._uses.questions.ask(self._uses.package, question, answers, tell, self.extension)

    def report(
        self,
        task: str,
        title: str,
        text: str = "",
        rows: Iterable[Iterable[object]] = (),
        picture: bytes | None = None,
    ) -> None:
        """Write a chapter into the report of a task, by its id: a text, rows of a small table, a picture.

        It is kept in the flight record, and waits for nothing: where the disk is full or the plant writes no
        record, the log says that it is lost. A text is cut at 10,000 letters, a table at 200 rows. Raises
        ValueError without a title, and for a picture that is no PNG, JPEG or SVG of at most 2 MB.
        """
        self._uses.chapters.add(self._uses.package, task, title, text, rows, picture)

    def _then(self, first: Future[Given], made: Callable[[Given], Found]) -> Future[Found]:
        """A future of what is made of another one's result."""
        following: Future[Found] = Answer(self._uses.telling.each)
        first.add_done_callback(partial(_pass_on, made=made, following=following))
        return following

    def table(self, name: str = "") -> Table:
        """A table of this part in the memory of the plant; a part that has several gives each a name."""
        return self._uses.table(f"{self.extension}.{name}" if name else self.extension)

    @property
    def folder(self) -> Path:
        """A folder of this part in the state directory of this host, for what is too large for a table."""
        return self._uses.folder()

    def show(self, **values: object) -> None:
        """Show these values on the page, besides those shown before: by name, as items of a `Page` have it.

        They are plain data, as JSON has it; raises ValueError or TypeError for anything else.
        """
        plain = json.loads(json.dumps(values, allow_nan=False))
        with self._showing:
            self._shown = {**self._shown, **plain}

    @property
    def shown(self) -> Mapping[str, Any]:
        """The values that are shown now."""
        return self._shown


def _is_repeated(change: TaskChanged, waiting: set[str]) -> bool:
    """True for the answer to somebody who asks again for a task that the plant has; `waiting` are the tasks
    that were told to wait."""
    if change.state is not TaskState.QUEUED:
        waiting.discard(change.task)
        return change.request is not None and change.state is not TaskState.REFUSED
    is_known = change.task in waiting
    waiting.add(change.task)
    return is_known


def _task(row: Mapping[str, Any]) -> Task:
    texts = {key: str(row[key]) for key in ("sentence", "choice") if row.get(key) is not None}
    id = row["id"] or row["text"].partition("#")[2]  # the plant knows none of a task that it refuses
    found: Task = read(Task, {**explained(row), **texts, "id": id})
    return found


def _done(answer: OperatorAnswer) -> Done:
    if answer.refusal is not None:
        raise Refused(answer.refusal)
    why = None if answer.why is None else str(answer.why)
    outcome = None if answer.outcome is None else answer.outcome.value
    return Done(verb=answer.verb.value, scope=answer.scope, act=answer.act, outcome=outcome, why=why)


def _device(robot: Robot, cells: tuple[str, ...], facts: Any) -> Device:
    driver = robot.driver
    return Device(
        name=robot.name,
        kind=robot.kind_name,
        cells=cells,
        driver="" if driver is None else driver.name,
        settings=None if driver is None else driver.settings,
        facts=facts,
    )


def _pass_on(first: Future[Given], *, made: Callable[[Given], Found], following: Future[Found]) -> None:
    try:
        following.set_result(made(first.result()))
    except Exception as error:  # noqa: BLE001 - it is raised where somebody waits for the result
        following.set_exception(error)
