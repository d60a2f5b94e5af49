"""Writer of one start's record as a row of files: messages go into the last one until it is full."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Protocol

from arboleda.host.packages import EXTRAS, entry_points
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Limits

from .channels import OURS, Channel
from .chapter import Chapter
from .files import DIGEST, PartFile, part_bytes, part_path, prune
from .preamble import Beginning
from .steps import TOPIC, Step, as_json
from .version_files import VersionFiles
from .view_log import Message, ViewLog, ViewSnapshot

FLUSH_S = 1.0  # at most this is lost with a killed process or power
LEAST_FREE = 200_000_000  # bytes to keep free on the disk for the plant's memory and anything else


class Log(Protocol):
    """Source of a record's messages, made of steps and snapshots; None between two pieces of work."""

    @property
    def channels(self) -> Sequence[Channel]: ...
    def stepped(self, step: Step) -> Iterator[Message | None]: ...
    def saw(self, snapshot: ViewSnapshot) -> Iterator[Message | None]: ...
    def whole(self) -> Iterator[Message | None]:
        """The whole view so far, for the beginning of a file."""


def ros_logs(model: PlantModel) -> list[Log]:
    """Writers of this plant's record for tools of ROS 2."""
    return [each.load()(model) for each in entry_points(EXTRAS) if each.name == "ros_log"]


class Writing:
    """Writer of a record: `open`, then `put` and `tend` repeatedly, then `close`; raises OSError.

    Old files go as new ones come, within the `limits`; `ran_s` says how long the plant has run.
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
        ran_s: Callable[[], float] = float,  # of a plant whose time nobody counts no file is old
        least_free: int = LEAST_FREE,
    ) -> None:
        self._view = view or ViewLog()
        self._logs = (self._view, *logs)
        self._channels = (*OURS, *(channel for log in self._logs for channel in log.channels))
        self._folder = folder
        self._beginning = beginning
        self._limits = limits
        self._unix_ns = unix_ns
        self._ran_s = ran_s
        self._least_free = least_free
        self._part: PartFile | None = None
        self._number = self._digests = 0
        self._flushed_ns = 0

    def open(self) -> None:
        """Begin the next file, with the whole view so far."""
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._refuse_full_disk()
        now = self._flushed_ns = self._unix_ns()
        ran_s = self._ran_s()
        prune(self._folder, self._limits, ran_s)
        self._number += 1
        path = part_path(self._folder, self._beginning.epoch, self._number)
        self._part = PartFile(path, self._beginning, self._number, now, self._channels, ran_s)
        for log in self._logs:
            for message in filter(None, log.whole()):
                self._part.put(*message)

    def put(self, item: Step | ViewSnapshot | VersionFiles | Chapter) -> Iterator[None]:
        """Write the messages of a step or snapshot; in pieces, between which others may work."""
        if isinstance(item, VersionFiles | Chapter):
            if self._part is not None:
                self._part.attach(item.name, item.unix_ns, item.data())
            return
        for message in self._messages(item):
            if message is not None and self._part is not None:
                self._part.put(*message)
            yield

    def tend(self) -> None:
        """Write to the disk if that is due."""
        passed_ns = self._unix_ns() - self._flushed_ns  # negative if the clock was set back
        if self._part is None or 0 <= passed_ns < FLUSH_S * 1e9:
            return
        self._refuse_full_disk()
        self._flushed_ns = self._unix_ns()
        self._digest(self._part)
        if self._part.flush() >= part_bytes(self._limits):
            self.close()
            self.open()

    def close(self) -> None:
        """End the last file as other tools expect it."""
        if self._part is not None:
            self._digest(self._part, ends=True)
            self._part.close()

    def drop(self) -> None:
        """Leave the last file without an end."""
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
        """Attach the newest part of the time line, where it is found without reading messages."""
        digest = self._view.digest(ends=ends)
        if digest:
            self._digests += 1
            part.attach(f"{DIGEST}{self._digests:05}.json.zst", self._unix_ns(), digest)

    def _refuse_full_disk(self) -> None:
        free = shutil.disk_usage(self._folder).free
        if free < self._least_free:
            raise OSError(f"the disk has less than {self._least_free // 1_000_000} MB left")
