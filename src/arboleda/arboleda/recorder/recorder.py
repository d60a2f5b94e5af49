"""The thread that writes the record: whoever hands it a step waits for nothing."""

from __future__ import annotations

import logging
import shutil
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, Protocol

from arboleda.core.plant import Plant

from .beginning import Beginning, Limits
from .channels import OURS, Channel
from .files import DIGEST, PartFile, part_bytes, part_path, prune
from .state import state_of
from .steps import TOPIC, Step, as_json
from .view_log import Message, Seen, ViewLog

LOG = logging.getLogger(__name__)
PERIOD_S = 0.25  # between two looks at what waits
SLICE_S, PAUSE_S = 0.0003, 0.001  # of work, and between two slices of it, in which others have Python's lock
FLUSH_S = 5.0  # what a killed process loses at most
SHARE = 0.1  # of the time for what screens see, at most
MOST_WAITING = 20_000  # steps; some minutes of a large plant
LEAST_FREE = 200_000_000  # bytes that the disk keeps for the plant's memory and for whatever else is on it
PATIENCE_S = 5.0  # for the rest, at the end


class Log(Protocol):
    """What makes messages of steps and snapshots, in their order; None between two pieces of that work."""

    @property
    def channels(self) -> Sequence[Channel]: ...
    def stepped(self, step: Step) -> Iterator[Message | None]: ...
    def saw(self, seen: Seen) -> Iterator[Message | None]: ...
    def whole(self) -> Iterator[Message | None]:
        """All that was told so far, for the beginning of a file."""


class Recorder:
    """Writes what `stepped` and `saw` are told to files in `folder`, from `start` to `stop`.

    Where that cannot be, for whatever reason, the record ends: one line in the log says why, `trouble` too,
    and the plant goes on.
    """

    def __init__(
        self,
        folder: Path,
        beginning: Beginning,
        limits: Limits,
        logs: Sequence[Log] = (),
        *,
        view: ViewLog | None = None,
        unix_ns: Callable[[], int] = time.time_ns,
        least_free: int = LEAST_FREE,
    ) -> None:
        self.trouble = ""
        self._view = view or ViewLog()
        self._logs = (self._view, *logs)
        self._channels = (*OURS, *(channel for log in logs for channel in log.channels))
        self._folder = folder
        self._beginning = beginning
        self._limits = limits
        self._unix_ns = unix_ns
        self._least_free = least_free
        self._waiting: deque[Step | Seen] = deque()
        self._turn = 0
        self._seen_in = self._seen_out = 0  # snapshots that were told, and that were looked at
        self._see_after = 0.0
        self._over = False
        self._ending = threading.Event()
        self._part: PartFile | None = None
        self._number = self._digests = 0
        self._flushed_ns = 0
        self._thread = threading.Thread(target=self._work, name="recorder", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Write what waits and close the file; a disk that hangs is not waited for. Idempotent."""
        self._ending.set()
        if self._thread.ident is not None:
            self._thread.join(PATIENCE_S)

    def stepped(self, plant: Plant, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None:
        """Take in a step that was made just now; in the plant's thread, and never raises."""
        if self._over:
            return
        try:
            self._turn += 1
            step = Step(self._unix_ns(), now, events, messages, state_of(plant, self._turn))
        except Exception as error:  # noqa: BLE001 - a record that cannot be made must not end the plant
            self._give_up(f"{type(error).__name__}: {error}")
            return
        self._wait(step)

    def saw(self, snapshot: dict[str, Any], drawn: dict[str, Any]) -> None:
        """Take in a snapshot and the twin's positions, as screens get them; likewise in its thread."""
        if not self._over:
            self._seen_in += 1
            self._wait(Seen(self._unix_ns(), snapshot, drawn))

    def _wait(self, item: Step | Seen) -> None:
        if len(self._waiting) < MOST_WAITING:
            self._waiting.append(item)
        else:
            self._give_up(f"the disk is too slow: {MOST_WAITING} steps wait for it")

    def _work(self) -> None:
        try:
            self._open_next()
            while not self._ending.wait(PERIOD_S) and not self._over:
                self._write(pausing=True)
            self._write(pausing=False)
            self._close()
        except OSError as error:
            self._give_up(error.strerror or str(error))
        except Exception as error:
            LOG.debug("the record broke down", exc_info=error)
            self._give_up(f"{type(error).__name__}: {error}")
        finally:
            if self._over and self._part is not None:
                self._part.drop()

    def _write(self, *, pausing: bool) -> None:
        """Write what waits, in slices between which whoever needs the processor more may have it."""
        began = time.perf_counter()
        for message in self._messages():
            if message is not None:
                self._put(message)
            if pausing and time.perf_counter() - began > SLICE_S:
                time.sleep(PAUSE_S)
                began = time.perf_counter()
        if self._unix_ns() - self._flushed_ns >= FLUSH_S * 1e9:
            self._flush()

    def _put(self, message: Message) -> None:
        assert self._part is not None
        self._part.put(*message)

    def _messages(self) -> Iterator[Message | None]:
        """All that what waits is made of; None between two pieces of work."""
        while self._waiting and not self._over:
            item = self._waiting.popleft()
            if isinstance(item, Step):
                yield TOPIC, item.unix_ns, as_json(item)
                for log in self._logs:
                    yield from log.stepped(item)
            else:
                yield from self._looked_at(item)

    def _looked_at(self, seen: Seen) -> Iterator[Message | None]:
        """Where that takes more than its share of the time, a snapshot is passed over for the next one."""
        self._seen_out += 1
        now, spent_s = time.monotonic(), time.thread_time()
        if now < self._see_after and self._seen_out < self._seen_in:
            return
        for log in self._logs:
            yield from log.saw(seen)
        self._see_after = now + (time.thread_time() - spent_s) / SHARE

    def _digest(self, *, ends: bool = False) -> None:
        """Have the newest part of the time line where it is found at once."""
        assert self._part is not None
        digest = self._view.digest(ends=ends)
        if digest:
            self._digests += 1
            self._part.attach(f"{DIGEST}{self._digests:05}.json.zst", self._unix_ns(), digest)

    def _flush(self) -> None:
        assert self._part is not None
        self._refuse_full_disk()
        self._flushed_ns = self._unix_ns()
        self._digest()
        if self._part.flush() >= part_bytes(self._limits):
            self._close()
            self._open_next()

    def _refuse_full_disk(self) -> None:
        free = shutil.disk_usage(self._folder).free
        if free < self._least_free:
            raise OSError(f"the disk has less than {self._least_free // 1_000_000} MB left")

    def _open_next(self) -> None:
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._refuse_full_disk()
        now = self._flushed_ns = self._unix_ns()
        prune(self._folder, self._limits, now / 1e9)
        self._number += 1
        path = part_path(self._folder, self._beginning.epoch, self._number)
        self._part = PartFile(path, self._beginning, self._number, now, self._channels)
        for log in self._logs:
            for message in filter(None, log.whole()):
                self._put(message)

    def _close(self) -> None:
        if self._part is not None and not self._over:
            self._digest(ends=True)
            self._part.close()

    def _give_up(self, why: str) -> None:
        """End the record, once."""
        if self._over:
            return
        self._over = True
        self.trouble = why
        self._waiting.clear()
        LOG.warning("the record has stopped: %s; the plant goes on without it", why)
