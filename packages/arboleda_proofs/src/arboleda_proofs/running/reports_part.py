"""Reports of tasks that failed, written beside a plant that runs: one at a time, by a process of its own."""

from __future__ import annotations

import logging
import math
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from arboleda.drivers import plain, quoted
from arboleda.extension import ArboledaError, Phrase
from arboleda.host.limits import BEHIND
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.text import ID
from arboleda_proofs.running.api import ReportsApi

LOG = logging.getLogger(__name__)
FOLDER = "reports"
MOST_WAITING = 20  # a plant in which everything fails has one report after the other, and not all of them
MOST_KEPT = 100
AFTER_S = 12.0  # so long after a failure: by then its record is on the disk, with what came right after it
AT_MOST_S = 600.0
NO_RECORD = Phrase("report.no_record", "this plant writes no record, of which reports are made")
NO_TASK = Phrase("report.no_task", "{task} is not the id of a task")
TOO_MANY = Phrase("report.too_many", "{most} other reports wait; try again in some minutes")
SAID = Phrase("report.said", "{said}")


def _command(task: str, state: Path, target: Path) -> Sequence[str]:
    where = ["--state", str(state), "--output", str(target)]
    return [sys.executable, "-c", BEHIND, "report", *where, "--", task]


class NoReport(ArboledaError):
    """There is no report of a task; the sentence says why."""


class NoReports(ReportsApi):
    """Reports of a plant that writes no record."""

    def report(self, task: str) -> str | None:
        raise NoReport(NO_RECORD())


class ReportsPart(ReportsApi):
    """Has reports of tasks that failed written by others: those that somebody asks for, and with `changed`,
    which never raises, one of each task that fails.

    `command` makes the command line from the task, the plant's state directory and the file to write.
    """

    def __init__(
        self,
        state: Path,
        command: Callable[[str, Path, Path], Sequence[str]] = _command,
        *,
        after_s: float = AFTER_S,
    ) -> None:
        self._folder = state / FOLDER
        self._state = state
        self._command = command
        self._after_s = after_s
        self._turns = threading.Lock()  # held for moments: the plant's thread takes it, too
        self._waiting: dict[str, float] = {}  # task -> when its turn comes at the earliest
        self._writing: str | None = None
        self._objections: dict[str, str] = {}
        self._ending = threading.Event()
        self._news = threading.Event()
        self._starting = threading.Lock()  # a process that is started while the plant ends is ended, too
        self._run: subprocess.Popen[str] | None = None
        self._thread = threading.Thread(target=self._work, name="reports", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """End the report that is being written; waiting ones are left to `arboleda report`. Idempotent."""
        with self._starting:
            self._ending.set()
            if self._run is not None:
                self._run.kill()
        self._news.set()
        if self._thread.ident is not None:
            self._thread.join()

    def changed(self, task: TaskChanged) -> None:
        """Note a task that failed; a repeated request gets the failure once more, which is no news."""
        if task.state is not TaskState.FAILED or task.request is not None:
            return
        if not self._wait(task.task, self._after_s):
            LOG.warning(
                "no report of %s: %d others wait; `arboleda report` makes it", task.task, MOST_WAITING
            )

    def wrote(self, task: str) -> None:
        """Have a report that is there written anew, as a package has written about its task."""
        if ID.fullmatch(task) and self._file(task).exists():
            self._wait(task, self._after_s)

    def report(self, task: str) -> str | None:
        """The report of a task, in HTML; None: it is being written now, ask again. NoReport says why there is
        none, and asking once more tries once more."""
        if not ID.fullmatch(task):
            raise NoReport(NO_TASK(task=quoted(task, 80)))
        with suppress(FileNotFoundError):
            return self._file(task).read_text("utf-8")
        with self._turns:
            objection = self._objections.pop(task, None)
            is_here = self._writing == task
        if objection is not None:
            raise NoReport(SAID(said=objection))
        if not is_here and not self._wait(task, 0.0):
            raise NoReport(TOO_MANY(most=MOST_WAITING))
        return None

    def _file(self, task: str) -> Path:
        return self._folder / f"{task}.html"

    def _wait(self, task: str, seconds: float) -> bool:
        """Queue the report for this delay, or sooner if that is wanted already; True if there is room."""
        due = time.monotonic() + seconds
        with self._turns:
            if task not in self._waiting and len(self._waiting) >= MOST_WAITING:
                return False
            self._waiting[task] = min(due, self._waiting.get(task, due))
        self._news.set()
        return True

    def _work(self) -> None:
        while not self._ending.is_set():
            task = self._next()
            if task is None:
                continue
            try:
                objection = self._write(task)
            except OSError as error:
                objection = error.strerror or str(error)
            with self._turns:
                self._writing = None
                if objection is not None and not self._ending.is_set():
                    self._objections[task] = objection
                    for old in [*self._objections][:-MOST_WAITING]:
                        del self._objections[old]
            if objection is not None and not self._ending.is_set():
                LOG.warning("no report of %s: %s", task, objection)

    def _next(self) -> str | None:
        """The task whose turn it is, once it has come; None if there is news meanwhile."""
        with self._turns:
            task = min(self._waiting, key=self._waiting.__getitem__, default=None)
            due = self._waiting.get(task or "", math.inf)
        if self._news.wait(None if due == math.inf else max(0.0, due - time.monotonic())):
            self._news.clear()
            return None
        with self._turns:
            self._writing = task
            self._waiting.pop(task or "", None)
        return task

    def _write(self, task: str) -> str | None:
        """Write the report of a task; returns the reason if there is none."""
        self._folder.mkdir(mode=0o700, exist_ok=True)
        _prune(self._folder)
        made = self._folder / f"{task}.part"  # nobody is shown half of one
        with self._starting:
            if self._ending.is_set():
                return None
            run = self._run = subprocess.Popen(
                self._command(task, self._state, made),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                umask=0o077,
            )
        output = _output(run)
        if run.returncode != 0:
            made.unlink(missing_ok=True)
            return plain(output.strip().rpartition("\n")[2].removeprefix("arboleda: "), 300)
        made.replace(self._file(task))
        LOG.info("report of %s: %s (%s)", task, plain(output.partition("\n")[0], 200), self._file(task))
        return None


def _output(run: subprocess.Popen[str]) -> str:
    """The output of the process until its end; it is killed if it takes too long."""
    try:
        return run.communicate(timeout=AT_MOST_S)[0]
    except subprocess.TimeoutExpired:
        run.kill()
        return run.communicate()[0]


def _prune(folder: Path) -> None:
    """Delete the oldest report if there is no room for one more."""
    kept = sorted(folder.glob("*.html"), key=lambda path: path.stat().st_mtime)
    for path in kept[: max(0, len(kept) - MOST_KEPT + 1)]:
        path.unlink(missing_ok=True)
