"""The state directory of a running plant: one owner at a time, and the address of the plant."""

from __future__ import annotations

import errno
import json
import os
import re
import time
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from datetime import datetime, timezone
from pathlib import Path

from arboleda.host import files, locks
from arboleda.host.state_folders import default_state as default_state
from arboleda.host.state_folders import plants_root
from arboleda.host.state_folders import state_root as state_root
from arboleda.model.errors import ArboledaError, ConfigError, StartError
from arboleda.plant_file.user_file import read_bytes
from arboleda.store.held_files import HeldFiles
from arboleda.wire import epochs

from .host_claim import HostClaim, place_claim

STORE = "plant.sqlite"
LOCK = "plant.lock"
FACTS = "plant.json"
EPOCH = "epoch"
EPOCH_SAID, EPOCH_BYTES = re.compile(rb"(?:sum=([0-9a-f]{8}) )?([0-9]{1,10})\s*"), 64
NO_ROOM = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
LOCK_TRIES, LOCK_PAUSE_S = 5, 0.05  # a `status` looks at the lock for a moment; that is no owner


def running_plants() -> list[Path]:
    """The default state directories on which a plant runs now, by name."""
    try:
        return [path for path in sorted(plants_root().iterdir()) if find_running(path) is not None]
    except OSError:
        return []


def plants_of_databases() -> list[Path]:
    """The default state directories whose last plant had its memory in a database, by name."""
    try:
        return [path for path in sorted(plants_root().iterdir()) if (last := last_run(path)) and last.store]
    except OSError:
        return []


@dataclass(frozen=True, kw_only=True)
class Running:
    """The process that runs a plant, and its HTTP API as this machine reaches it: `port` is None until it
    listens, `host` is as in a URL (`[::1]`). `guarded` if everybody needs a token; `certificate` is the one
    that it shows with TLS, as PEM. `plant` is its name, `store` the database that keeps its memory, "" a file
    of this directory."""

    pid: int
    started: str
    port: int | None = None
    host: str = "127.0.0.1"
    guarded: bool = False
    certificate: str = ""
    plant: str = ""
    store: str = ""

    @property
    def url(self) -> str:
        return f"{'https' if self.certificate else 'http'}://{self.host}:{self.port}"


class StateDir:
    """The exclusive owner of a state directory from `open` to `close`, as `with` does it."""

    def __init__(self, path: Path, *, plant: str = "", store: str = "") -> None:
        self.path = path
        self._lock: int | None = None
        self._held = HeldFiles()
        self._claim: HostClaim | None = None
        started = datetime.now(timezone.utc).isoformat(timespec="seconds")
        self._running = Running(pid=os.getpid(), started=started, plant=plant, store=store)

    def open(self) -> None:
        """Take the directory; StartError names its owner, or the reason for which it cannot be used."""
        with self._explained():
            self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
            lock = os.open(self.path / LOCK, os.O_RDWR | os.O_CREAT | files.BINARY, 0o600)
        if not take(lock):
            os.close(lock)
            raise StartError(
                f"{holder(self.path)} End it first, or give this plant its own --state directory."
            )
        self._lock, self._held = lock, HeldFiles([self.path / LOCK])
        try:
            self._claim = place_claim(self.path)
            self._claim.take()
            with self._explained():
                (self.path / FACTS).unlink(missing_ok=True)
                files.write_anew(lock, json.dumps(asdict(self._running)).encode())
        except StartError:
            self.close()
            raise

    def next_epoch(self, unix_s: int) -> int:
        """A number for this start, higher than that of any start before, whatever the clock said then;
        StartError if the last number is unknown, or no robot would take a higher one.

        By a clock that is far ahead of the last start it is the next number: boards refuse a leap.
        """
        last = self._last_epoch()
        leaps = last > 0 and not epochs.can_follow(unix_s, last)
        epoch = last + 1 if leaps or unix_s <= last else unix_s
        if epochs.objection(epoch, None) is not None:
            raise StartError(
                f"Robots would not obey this start: {self.path / EPOCH} says that the last one was number"
                f" {last}, and this machine's clock says {unix_s}. Set the clock if it is wrong; if the file"
                " is wrong, delete it and restart the boards that were told that number."
            )
        with self._explained():
            replace_file(self.path / EPOCH, _with_sum(epoch))
        return epoch

    def _last_epoch(self) -> int:
        file = self.path / EPOCH
        try:
            content = read_bytes(file, EPOCH_BYTES) if os.path.lexists(file) else b"0"
        except ConfigError:
            content = b""
        said = EPOCH_SAID.fullmatch(content)
        if said is None or (said[1] and content.decode().strip() != _with_sum(int(said[2]))):
            raise StartError(
                f"{file} does not say the number of the last start: delete it if this machine's clock is "
                "right, or write a number into it that is higher than any before; robots obey no lower one."
            )
        return int(said[2])

    def announce(
        self, port: int, *, host: str = "127.0.0.1", guarded: bool = False, certificate: str = ""
    ) -> None:
        """Write down the address of the HTTP API and its login (see `Running`)."""
        announced = replace(self._running, port=port, host=host, guarded=guarded, certificate=certificate)
        with self._explained():
            replace_file(self.path / FACTS, json.dumps(asdict(announced)))

    def close(self) -> None:
        """Give the directory back; idempotent. The lock file stays: removing it would let two owners in."""
        if self._lock is not None:
            self._held = HeldFiles()
            with suppress(OSError):  # the lock says that nobody runs, and the disk may be read-only by now
                (self.path / FACTS).unlink(missing_ok=True)
            os.close(self._lock)
            self._lock = None
        if self._claim is not None:
            self._claim.release()

    def confirm(self) -> None:
        """Raise ArboledaError if the lock of this process is not in its place; from any thread."""
        loss = self._held.loss()
        if loss is not None:
            raise ArboledaError(
                f"The state directory {self.path} cannot be used any more ({loss}), so that a second plant"
                " could start beside this one: put back what else was deleted or moved away there, and start"
                " again."
            )

    @contextmanager
    def _explained(self) -> Iterator[None]:
        """Turn an error of the system into one sentence."""
        try:
            yield
        except OSError as error:
            advice = "; make room on the disk and start again" if error.errno in NO_ROOM else ""
            sentence = f"The state directory {self.path} cannot be used: {error.strerror}{advice}."
            raise StartError(sentence) from error

    def __enter__(self) -> StateDir:
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _with_sum(epoch: int) -> str:
    """A number of a start with its checksum before it, so that one that was cut off or changed is not read.

    People write the number alone, as earlier versions did.
    """
    return f"sum={zlib.crc32(b'%d' % epoch):08x} {epoch}"


def replace_file(file: Path, content: str) -> None:
    """Replace a file as a whole, readable by its owner only, safe against a power cut; OSError, and all is as
    before, if that fails."""
    fresh = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        with os.fdopen(os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as opened:
            opened.write(content)
            opened.flush()
            os.fsync(opened.fileno())
        os.replace(fresh, file)
        files.sync_folder(file.parent)
    except OSError:
        fresh.unlink(missing_ok=True)
        raise


def find_running(path: Path) -> Running | None:
    """The process that runs a plant on `path`; None if there is none, whatever a killed one left behind."""
    try:
        lock = os.open(path / LOCK, os.O_RDONLY)
    except OSError:
        return None
    try:
        if locks.lock(lock, shared=True):
            return None
    finally:
        os.close(lock)
    return read_facts(path / FACTS) or read_facts(path / LOCK)


def last_run(path: Path) -> Running | None:
    """The process that runs a plant on `path`, or was the last to do so."""
    return read_facts(path / LOCK)


def read_facts(file: Path) -> Running | None:
    """The facts in a file, None if it is absent or half written."""
    try:
        return Running(**json.loads(file.read_bytes()))
    except (OSError, ValueError, TypeError):
        return None


def holder(path: Path) -> str:
    """The sentence on the process that holds the directory."""
    running = read_facts(path / LOCK)
    who = f"process {running.pid}, since {running.started}" if running else "another process"
    return f"A plant is already running on {path} ({who})."


def take(lock: int) -> bool:
    """Take the exclusive lock; True if it was free."""
    for attempt in range(LOCK_TRIES):
        if locks.lock(lock):
            return True
        if attempt + 1 < LOCK_TRIES:
            time.sleep(LOCK_PAUSE_S)
    return False
