"""Process that shows a plant to viewers of others: it gets lines of JSON made of snapshots, and may die."""

from __future__ import annotations

import json
import logging
import subprocess
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

LOG = logging.getLogger(__name__)
BEGIN = "import sys, json; path, *given = map(json.loads, sys.argv[1:]); sys.path[:] = path; "
Snapshot = Mapping[str, Any]


class ViewerProcess(ABC):
    """Keeps the process; `saw` takes each snapshot, in the plant's thread.

    `module` has a `main`, which prints a line of JSON once it is ready, and ends when
    its input does. `name` is that of the thread that writes to it, `task` says what it does.
    """

    def __init__(self, name: str, task: str, module: str) -> None:
        self._name, self._task, self._module = name, task, module
        self._process: subprocess.Popen[bytes] | None = None
        self._thread: threading.Thread | None = None
        self._news = threading.Event()
        self._latest: deque[tuple[int, Snapshot]] = deque(maxlen=1)
        self._stopping = False
        self.notes: list[str] = []

    @abstractmethod
    def lines(self, at_us: int, snapshot: Snapshot) -> Iterator[bytes]:
        """The lines for the process; called in a thread of its own. `at_us`: Unix time."""

    def saw(self, snapshot: Snapshot) -> None:
        """Queue a snapshot; an older one that was not shown yet is dropped."""
        self._latest.append((time.time_ns() // 1000, snapshot))
        self._news.set()

    def spawn(self, *given: object) -> subprocess.Popen[bytes]:
        """Start the process, with what its `main` is given."""
        run = f"import {self._module} as shown; shown.main(*given)"
        self._process = subprocess.Popen(
            [sys.executable, "-c", BEGIN + run, *map(json.dumps, [sys.path, *given])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        return self._process

    def answer(self, process: subprocess.Popen[bytes], seconds: float) -> dict[str, Any]:
        """The line of a process that is ready; empty if none came in that time, and then it is killed."""
        slow = threading.Timer(seconds, process.kill)
        slow.start()
        line = process.stdout.readline()  # type: ignore[union-attr]
        slow.cancel()
        slow.join()
        return dict(json.loads(line or b"{}"))

    def begin(self, process: subprocess.Popen[bytes]) -> None:
        """Begin to tell the process what is seen."""
        self._thread = threading.Thread(target=self.tell, args=(process,), name=self._name, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stopping = True
        self._news.set()
        if self._process is not None:
            self._process.kill()  # it holds nothing; and a thread that is writing to it goes on
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        if self._process is not None:
            self._process.wait()
            for pipe in (self._process.stdin, self._process.stdout):
                with suppress(BrokenPipeError):
                    pipe.close()  # type: ignore[union-attr]
            self._process = None

    def tell(self, process: subprocess.Popen[bytes]) -> None:
        """Send news to the process until the end; in a thread of its own, which may have to wait."""
        try:
            while not self._stopping:
                self._news.wait()
                self._news.clear()
                for line in self.lines(*self._latest.popleft()) if self._latest else ():
                    process.stdin.write(line)  # type: ignore[union-attr]
                    process.stdin.flush()  # type: ignore[union-attr]
        except OSError:
            self.lost("")

    def lost(self, why: str) -> None:
        """Note in the log that the process has ended, unless the plant ends."""
        if not self._stopping:
            LOG.error("what %s has ended%s; the plant goes on without it", self._task, why and f": {why}")
