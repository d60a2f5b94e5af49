"""One start's record as a row of files: what it is told goes into the last one, until that is full."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Protocol

from .channels import OURS, Channel
from .files import DIGEST, PartFile, part_bytes, part_path, prune
from .preamble import Beginning, Limits
from .steps import TOPIC, Step, as_json
from .view_log import Message, ViewLog, ViewSnapshot

FLUSH_S = 1.0  # what a killed process or a power cut loses at most
LEAST_FREE = 200_000_000  # bytes that the disk keeps for the plant's memory and for whatever else is on it


class Log(Protocol):
    """What makes messages of steps and snapshots, in their order; None between two pieces of that work."""

    @property
    def channels(self) -> Sequence[Channel]: ...
    def stepped(self, step: Step) -> Iterator[Message | None]: ...
    def saw(self, seen: ViewSnapshot) -> Iterator[Message | None]: ...
    def whole(self) -> Iterator[Message | None]:
        """All that was told so far, for the beginning of a file."""


class Writing:
    """`open`, then `put` and `tend` again and again, then `close`; OSError where it cannot be written.

    Old files go as new ones come, within the `limits`.
    """

    def __init__(
        self,
        folder: Path,
        beginning: Beginning,
        limits: Limits,
        logs: Iterable[Log] = (),
        *,
        view: ViewLog | None = None,
        unix_ns: Callable[[], int] = time.time_ns,
        least_free: int = LEAST_FREE,
    ) -> None:
        self._view = view or ViewLog()
        self._logs = (self._view, *logs)
        self._channels = (*OURS, *(channel for log in self._logs for channel in log.channels))
        self._folder = folder
        self._beginning = beginning
        self._limits = limits
        self._unix_ns = unix_ns
        self._least_free = least_free
        self._part: PartFile | None = None
        self._number = self._digests = 0
        self._flushed_ns = 0

    def open(self) -> None:
        """Begin the next file, with all that was told so far."""
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._refuse_full_disk()
        now = self._flushed_ns = self._unix_ns()
        prune(self._folder, self._limits, now / 1e9)
        self._number += 1
        path = part_path(self._folder, self._beginning.epoch, self._number)
        self._part = PartFile(path, self._beginning, self._number, now, self._channels)
        for log in self._logs:
            for message in filter(None, log.whole()):
                self._part.put(*message)

    def put(self, item: Step | ViewSnapshot) -> Iterator[None]:
        """Write what was told; in pieces, between which others may work."""
        for message in self._messages(item):
            if message is not None and self._part is not None:
                self._part.put(*message)
            yield

    def tend(self) -> None:
        """Have on the disk what was written, where that is due."""
        passed_ns = self._unix_ns() - self._flushed_ns  # less than nothing where the clock was set back
        if self._part is None or 0 <= passed_ns < FLUSH_S * 1e9:
            return
        self._refuse_full_disk()
        self._flushed_ns = self._unix_ns()
        self._digest(self._part)
        if self._part.flush() >= part_bytes(self._limits):
            self.close()
            self.open()

    def close(self) -> None:
        """End the last file as other tools want it."""
        if self._part is not None:
            self._digest(self._part, ends=True)
            self._part.close()

    def drop(self) -> None:
        """Leave the last file as it is."""
        if self._part is not None:
            self._part.drop()

    def _messages(self, item: Step | ViewSnapshot) -> Iterator[Message | None]:
        if isinstance(item, Step):
            yield TOPIC, item.unix_ns, as_json(item)
            for log in self._logs:
                yield from log.stepped(item)
        else:
            for log in self._logs:
                yield from log.saw(item)

    def _digest(self, part: PartFile, *, ends: bool = False) -> None:
        """Have the newest part of the time line where it is found at once."""
        digest = self._view.digest(ends=ends)
        if digest:
            self._digests += 1
            part.attach(f"{DIGEST}{self._digests:05}.json.zst", self._unix_ns(), digest)

    def _refuse_full_disk(self) -> None:
        free = shutil.disk_usage(self._folder).free
        if free < self._least_free:
            raise OSError(f"the disk has less than {self._least_free // 1_000_000} MB left")
