"""Pace of the plant's commits: times them, and reports when they get slow and fast again."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from types import TracebackType

from arboleda.adapters import clock
from arboleda.views import diagnostics

from .commit_pace import CommitPace, Pace

LOG = logging.getLogger(__name__)


class MemoryPace:
    """A context around each commit, in the plant's thread; `look` judges from any other one.

    `observers` get the seconds of each commit, `listeners` each change from slow to fast and back.
    """

    def __init__(self) -> None:
        self.observers: list[Callable[[float], None]] = []
        self.listeners: list[Callable[[Pace], None]] = []
        self._lock = threading.Lock()
        self._commits = CommitPace()
        self._begun: float | None = None
        self._pace = Pace()

    @property
    def pace(self) -> Pace:
        """The pace at the last look."""
        return self._pace

    def look(self) -> None:
        """Judge the pace now, with a commit that hangs, and report a change."""
        now = clock.seconds()
        with self._lock:
            pending_s = 0.0 if self._begun is None else now - self._begun
            before, self._pace = self._pace, self._commits.pace(now, pending_s)
        if before.is_slow is self._pace.is_slow:
            return
        LOG.warning("%s", self._pace.sentence)
        for listener in self.listeners:
            listener(self._pace)

    def diagnosis(self) -> diagnostics.Diagnostic:
        """The pace as a diagnosis for /diagnostics."""
        return diagnostics.memory(self._pace.sentence if self._pace.is_slow else None)

    def __enter__(self) -> None:
        with self._lock:
            self._begun = clock.seconds()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._lock:
            now, begun, self._begun = clock.seconds(), self._begun, None
            seconds = 0.0 if begun is None else now - begun
            self._commits.committed(seconds, now)
        for observer in self.observers:
            observer(seconds)
