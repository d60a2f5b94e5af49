"""Tasks asked for together, followed until none of them can go on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any

from arboleda.model.messages import TaskChanged, TaskState

ENDED = frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED, TaskState.REFUSED})


class Errand:
    """Ask `submit` for every text; `finished` is called once, in the plant's thread, at the end of all."""

    def __init__(self, texts: Sequence[str], finished: Callable[[], None]) -> None:
        self.texts = tuple(texts)
        self.results: dict[str, TaskChanged] = {}
        self.seconds: dict[str, float] = {}
        self._finished = finished
        self._asked = 0
        self._blocked: set[str | None] = set()
        self._told = False
        self._started: dict[str, float] = {}
        self._lock = threading.Lock()

    @property
    def ok(self) -> bool:
        """Whether every task is done."""
        done = [change.state is TaskState.DONE for change in self.results.values()]
        return self._asked == len(self.texts) and all(done)

    def start(self, submit: Callable[[str], Future[TaskChanged]]) -> None:
        for text in self.texts:
            submit(text).add_done_callback(lambda answer: self._answered(answer.result()))

    def changed(self, change: TaskChanged) -> None:
        """Listen to every change of the plant; those of other tasks do not matter."""
        with self._lock:
            if change.task not in self.results:
                return
            self._note(change)
        self._finish_if_over()

    def seen(self, snapshot: dict[str, Any]) -> None:
        """Look at every snapshot of the plant: which cells start no task before an operator acts."""
        blocked = [cell["name"] for cell in snapshot["cells"] if cell["paused"] and not cell["task"]]
        with self._lock:
            self._blocked = set(blocked)
        self._finish_if_over()

    def _answered(self, change: TaskChanged) -> None:
        with self._lock:
            self._asked += 1
            key = change.task or f"refused {self._asked}"
            self.results[key] = change
        self._finish_if_over()

    def _finish_if_over(self) -> None:
        with self._lock:
            over = self._over() and not self._told
            self._told = self._told or over
        if over:
            self._finished()

    def _note(self, change: TaskChanged) -> None:
        self.results[change.task] = change
        if change.state is TaskState.RUNNING:
            self._started[change.task] = time.monotonic()
        elif change.task in self._started:
            self.seconds[change.task] = time.monotonic() - self._started[change.task]

    def _over(self) -> bool:
        if self._asked < len(self.texts):
            return False
        waiting = [change for change in self.results.values() if change.state not in ENDED]
        return all(change.state is TaskState.QUEUED and change.cell in self._blocked for change in waiting)
