"""Thread that writes the record; handing it a step never waits."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from arboleda.engine import Plant
from arboleda.model.plant_files import PlantFiles

from .chapter import Chapter
from .state import state_of
from .steps import Step
from .version_files import VersionFiles
from .view_log import ViewSnapshot
from .writing import FLUSH_S, Writing

LOG = logging.getLogger(__name__)
PERIOD_S = FLUSH_S  # interval of looks at the queue: what is written sooner reaches the disk no sooner
SLICE_S, PAUSE_S = 0.0003, 0.001  # of work, and between two slices of it, in which others have Python's lock
SHARE = 0.1  # greatest share of the time for snapshots
MOST_WAITING = 20_000  # steps; some minutes of a large plant
PATIENCE_S = 5.0  # for the rest, at the end
MOST_CHAPTERS = 50  # of reports that wait, of some MB each


class Recorder:
    """Writer of the record, in a thread of its own, from `start` to `stop`.

    If writing fails, for whatever reason, the record ends: one line in the log tells the reason, as does
    `trouble`, and the plant goes on.
    """

    def __init__(self, writing: Writing, unix_ns: Callable[[], int] = time.time_ns) -> None:
        self.trouble = ""
        self._writing = writing
        self._unix_ns = unix_ns
        self._waiting: deque[Step | ViewSnapshot | VersionFiles] = deque()
        self._chapters: deque[Chapter] = deque()
        self.wrote: list[Callable[[str], None]] = []  # told of their tasks; they are on the disk soon
        self._turn = 0
        self._snapshots_in = self._snapshots_out = 0
        self._see_after = 0.0
        self._over = False
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._work, name="recorder", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Write the rest and close the file, without waiting for a disk that hangs. Idempotent."""
        self._ending.set()
        if self._thread.ident is not None:
            self._thread.join(PATIENCE_S)

    def stepped(self, plant: Plant, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None:
        """Take in a step in the plant's thread; never raises."""
        if self._over:
            return
        try:
            self._turn += 1
            step = Step(self._unix_ns(), now, events, messages, state_of(plant, self._turn))
        except Exception as error:  # noqa: BLE001 - a record that cannot be made must not end the plant
            self._give_up(f"{type(error).__name__}: {error}")
            return
        self._wait(step)

    def knows(self, digest: str, files: PlantFiles) -> None:
        """Take in the files of a version, before the first step that uses it; from any thread."""
        if not self._over:
            self._wait(VersionFiles(digest=digest, files=files, unix_ns=self._unix_ns()))

    def saw(self, snapshot: dict[str, Any], drawn: dict[str, Any]) -> None:
        """Take in a snapshot and the twin's positions in the plant's thread; never raises."""
        if not self._over:
            self._snapshots_in += 1
            self._wait(ViewSnapshot(self._unix_ns(), snapshot, drawn))

    def add(self, chapter: Chapter) -> None:
        """Take in a chapter of the report of a task; from any thread."""
        if self._over or len(self._chapters) >= MOST_CHAPTERS:
            why = self.trouble or f"{MOST_CHAPTERS} others wait for the disk"
            LOG.warning(
                "a chapter of %s for the report of %s is lost: %s", chapter.package, chapter.task, why
            )
            return
        self._chapters.append(replace(chapter, unix_ns=self._unix_ns()))

    def _wait(self, item: Step | ViewSnapshot | VersionFiles) -> None:
        if len(self._waiting) < MOST_WAITING:
            self._waiting.append(item)
        else:
            self._give_up(f"the disk is too slow: {MOST_WAITING} steps wait for it")

    def _work(self) -> None:
        try:
            self._writing.open()
            while not self._ending.wait(PERIOD_S) and not self._over:
                self._write(pausing=True)
            self._write(pausing=False)
            if not self._over:
                self._writing.close()
        except OSError as error:
            self._give_up(error.strerror or str(error))
        except Exception as error:
            LOG.debug("the record broke down", exc_info=error)
            self._give_up(f"{type(error).__name__}: {error}")
        finally:
            if self._over:
                self._writing.drop()

    def _write(self, *, pausing: bool) -> None:
        """Write all that waits, in slices, so that others may have the processor in between."""
        began = time.perf_counter()
        while self._waiting and not self._over:
            for _ in self._put(self._waiting.popleft()):
                if pausing and time.perf_counter() - began > SLICE_S:
                    time.sleep(PAUSE_S)
                    began = time.perf_counter()
        written = [*self._write_chapters()]
        if not self._over:
            self._writing.tend()
        for chapter in written:
            for tell in self.wrote:
                tell(chapter.task)

    def _write_chapters(self) -> Iterator[Chapter]:
        while self._chapters and not self._over:
            chapter = self._chapters.popleft()
            for _ in self._writing.put(chapter):
                pass
            yield chapter

    def _put(self, item: Step | ViewSnapshot | VersionFiles) -> Iterator[None]:
        """Write a step, or a snapshot if snapshots have not used up their share of the time; else skip it."""
        if not isinstance(item, ViewSnapshot):
            yield from self._writing.put(item)
            return
        self._snapshots_out += 1
        now, spent_s = time.monotonic(), time.thread_time()
        if now >= self._see_after or self._snapshots_out == self._snapshots_in:
            yield from self._writing.put(item)
            self._see_after = now + (time.thread_time() - spent_s) / SHARE

    def _give_up(self, why: str) -> None:
        """End the record, once."""
        if self._over:
            return
        self._over = True
        self.trouble = why
        self._waiting.clear()
        self._chapters.clear()
        LOG.warning("the record has stopped: %s; the plant goes on without it", why)
