"""Tasks asked for together, followed until none of them can go on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

from arboleda.model.cell_states import CellState
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.sentence import Sentence

ENDED = frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED, TaskState.REFUSED})


@dataclass(frozen=True, kw_only=True)
class Absence:
    """A cell that begins none of the tasks because devices of it are offline, since `since` on the clock."""

    since: float
    why: tuple[Sentence, ...]  # for each device


class Errand:
    """Ask `submit` for every text; `finished` is called once, in the plant's thread, at the end of all.

    A task that waits for a device that was offline for `patience_s` counts as over, like all others; None: it
    is waited for. So does a task behind one of an earlier start, for which a person has to decide.
    """

    def __init__(
        self,
        texts: Sequence[str],
        finished: Callable[[], None],
        *,
        patience_s: float | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.texts = tuple(texts)
        self._patience_s = patience_s
        self._clock = clock
        self.missing: tuple[Sentence, ...] = ()  # what is said of devices that were waited for in vain
        self._cells: set[str | None] = set()
        self._absent: dict[str | None, Absence] = {}
        self.results: dict[str, TaskChanged] = {}
        self.seconds: dict[str, float] = {}
        self._finished = finished
        self._answer_count = 0
        self._blocked: dict[str | None, Sentence | None] = {}  # by cell, why tasks wait there
        self._is_reported = False
        self._started: dict[str, float] = {}
        self._lock = threading.Lock()

    @property
    def needs_person(self) -> bool:
        """True where a task could not begin before a person acts."""
        waiting = (change.cell for change in self._waiting())
        return any(cell in self._blocked and not self._is_given_up(cell) for cell in waiting)

    @property
    def ok(self) -> bool:
        """True if every task is done."""
        done = [change.state is TaskState.DONE for change in self.results.values()]
        return self._answer_count == len(self.texts) and all(done)

    def start(self, submit: Callable[[str], Future[TaskChanged]]) -> None:
        for text in self.texts:
            submit(text).add_done_callback(lambda answer: self._answered(answer.result()))

    def changed(self, change: TaskChanged) -> None:
        """Take any change of a task; those of other tasks do not matter."""
        with self._lock:
            if change.task not in self.results:
                return
            self._note(change)
        self._finish_if_over()

    def note_snapshot(self, snapshot: dict[str, Any]) -> None:
        """Note which cells of a snapshot start no task before an operator acts or a device is back."""
        with self._lock:
            idle = [cell for cell in snapshot["cells"] if not cell["task"]]
            held = [cell for cell in snapshot["cells"] if self._is_of_before(cell)]
            absent = _absent([*(cell for cell in idle if cell["not_ready"]), *held], snapshot["robots"])
            blocked = [cell for cell in idle if cell["paused"]]
            blocked += [cell for cell in held if cell["advice"] and cell["name"] not in absent]
            now = self._clock()
            known = {cell: each.since for cell, each in self._absent.items()}
            self._cells = {cell["name"] for cell in snapshot["cells"]}
            self._blocked = {cell["name"]: cell.get("waiting_for") for cell in blocked}
            self._absent = {
                cell: Absence(since=known.get(cell, now), why=why) for cell, why in absent.items()
            }
        self._finish_if_over()

    def _answered(self, change: TaskChanged) -> None:
        with self._lock:
            self._answer_count += 1
            key = change.task or f"refused {self._answer_count}"
            self.results[key] = change
        self._finish_if_over()

    def _finish_if_over(self) -> None:
        with self._lock:
            over = self._over() and not self._is_reported
            self._is_reported = self._is_reported or over
            if over:
                self._say_what_is_missing()
        if over:
            self._finished()

    def _note(self, change: TaskChanged) -> None:
        self.results[change.task] = change
        if change.state is TaskState.RUNNING:
            self._started[change.task] = time.monotonic()
        elif change.task in self._started:
            self.seconds[change.task] = time.monotonic() - self._started[change.task]

    def _over(self) -> bool:
        if self._answer_count < len(self.texts):
            return False
        return all(
            change.state is TaskState.QUEUED and self._is_stuck(change.cell) for change in self._waiting()
        )

    def _is_of_before(self, cell: dict[str, Any]) -> bool:
        """True for a cell that is held with a task of an earlier start, or of another client."""
        task = cell["task"]
        return task is not None and cell["state"] == CellState.HELD and task["id"] not in self.results

    def _say_what_is_missing(self) -> None:
        """Replace the sentences of tasks that wait by those that are true now."""
        for task, change in self.results.items():
            if change.state is TaskState.QUEUED and (why := self._blocked.get(change.cell)) is not None:
                self.results[task] = replace(change, sentence=why)
        gone = {cell: each for cell, each in self._absent.items() if self._is_given_up(cell)}
        for task, change in self.results.items():
            found = [each for cell, each in gone.items() if change.cell in (cell, None)]
            if change.state is TaskState.QUEUED and found:
                reasons = [why for absence in found for why in absence.why]
                self.results[task] = replace(change, sentence=reasons[0])
                self.missing = tuple(dict.fromkeys((*self.missing, *reasons)))

    def _waiting(self) -> list[TaskChanged]:
        return [change for change in self.results.values() if change.state not in ENDED]

    def _is_stuck(self, cell: str | None) -> bool:
        """True if a cell starts no task; for None, if no cell does."""
        if cell is None:
            return bool(self._cells) and all(map(self._is_stuck, self._cells))
        return cell in self._blocked or self._is_given_up(cell)

    def _is_given_up(self, cell: str | None) -> bool:
        absence = self._absent.get(cell)
        if absence is None or self._patience_s is None:
            return False
        return self._clock() - absence.since >= self._patience_s


def _absent(
    cells: Iterable[dict[str, Any]], robots: Iterable[dict[str, Any]]
) -> dict[str, tuple[Sentence, ...]]:
    """Those of these cells of which devices are offline, with a sentence about each device."""
    offline = {
        robot["name"]: robot["obstacle"] for robot in robots if not robot["online"] and robot["obstacle"]
    }
    said = {
        cell["name"]: tuple(offline[each["name"]] for each in cell["devices"] if each["name"] in offline)
        for cell in cells
    }
    return {cell: why for cell, why in said.items() if why}
