"""Reports of tasks that failed, written beside a plant that runs: one at a time, by a process of its own."""

from __future__ import annotations

import logging
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path

from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.outside import plain

LOG = logging.getLogger(__name__)
FOLDER = "reports"
MOST_WAITING = 20  # a plant in which everything fails has one report after the other, and not all of them
MOST_KEPT = 100
AFTER_S = 12.0  # so long after a failure: by then its record is on the disk, with what came right after it
AT_MOST_S = 600.0
NICE = "import os, sys; os.nice(10); from arboleda.app.cli import main; sys.argv[0] = 'arboleda'; main()"


def _command(task: str, state: Path, target: Path) -> Sequence[str]:
    where = ["--state", str(state), "--output", str(target)]
    return [sys.executable, "-c", NICE, "report", *where, "--", task]


class ReportsPart:
    """Notes tasks that fail, in the plant's thread, and has their reports written by others; never raises.

    `command` makes what is run of the task, the plant's state directory and the file to write.
    """

    def __init__(
        self,
        state: Path,
        command: Callable[[str, Path, Path], Sequence[str]] = _command,
        *,
        after_s: float = AFTER_S,
    ) -> None:
        self._state = state
        self._command = command
        self._after_s = after_s
        self._waiting: deque[str] = deque()
        self._ending = threading.Event()
        self._failed = threading.Event()
        self._starting = threading.Lock()  # a process that is started while the plant ends is ended, too
        self._run: subprocess.Popen[str] | None = None
        self._thread = threading.Thread(target=self._work, name="reports", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """End the report that is being written; what waits is left to `arboleda report`. Idempotent."""
        with self._starting:
            self._ending.set()
            if self._run is not None:
                self._run.kill()
        self._failed.set()
        if self._thread.ident is not None:
            self._thread.join()

    def changed(self, task: TaskChanged) -> None:
        """Note a task that failed; who asks for it again is told of it again, which is no news."""
        if task.state is not TaskState.FAILED or task.request is not None:
            return
        if len(self._waiting) >= MOST_WAITING:
            LOG.warning(
                "no report of %s: %d others wait; `arboleda report` makes it", task.task, MOST_WAITING
            )
            return
        self._waiting.append(task.task)
        self._failed.set()

    def _work(self) -> None:
        while not self._ending.is_set():
            self._failed.wait()
            self._failed.clear()
            while self._waiting and not self._ending.wait(self._after_s):
                task = self._waiting.popleft()
                try:
                    self._write(task)
                except OSError as error:
                    LOG.warning("no report of %s: %s", task, error.strerror or error)

    def _write(self, task: str) -> None:
        folder = self._state / FOLDER
        folder.mkdir(mode=0o700, exist_ok=True)
        _prune(folder)
        target = folder / f"{task}.html"
        with self._starting:
            if self._ending.is_set():
                return
            run = self._run = subprocess.Popen(
                self._command(task, self._state, target),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                umask=0o077,
            )
        said = _said(run)
        if run.returncode == 0:
            LOG.info("why %s failed: %s (%s)", task, plain(said.partition("\n")[0], 200), target)
        elif not self._ending.is_set():
            LOG.warning("no report of %s: %s", task, plain(said.strip().rpartition("\n")[2], 300))


def _said(run: subprocess.Popen[str]) -> str:
    """What it said until its end; it is ended where it takes too long."""
    try:
        return run.communicate(timeout=AT_MOST_S)[0]
    except subprocess.TimeoutExpired:
        run.kill()
        return run.communicate()[0]


def _prune(folder: Path) -> None:
    """Leave room for one more: the oldest goes."""
    kept = sorted(folder.glob("*.html"), key=lambda path: path.stat().st_mtime)
    for path in kept[: max(0, len(kept) - MOST_KEPT + 1)]:
        path.unlink(missing_ok=True)
