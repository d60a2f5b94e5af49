"""The state directory of a running plant: one owner at a time, and where to reach it."""

from __future__ import annotations

import fcntl
import json
import os
import time
from dataclasses import asdict, dataclass, replace
from datetime import datetime, timezone
from pathlib import Path

from arboleda.core.errors import StartError

LOCK = "plant.lock"
FACTS = "plant.json"
EPOCH = "epoch"
LOCK_TRIES, LOCK_PAUSE_S = 5, 0.05  # a `status` looks at the lock for a moment; that is no owner


def default_state(plant: str) -> Path:
    """`$XDG_STATE_HOME/arboleda/<plant>`, else `~/.local/state/arboleda/<plant>`."""
    base = os.environ.get("XDG_STATE_HOME", "")
    root = Path(base) if os.path.isabs(base) else Path.home() / ".local" / "state"
    return root / "arboleda" / plant


@dataclass(frozen=True, kw_only=True)
class Running:
    """Who runs the plant; `port` is that of its HTTP API, None until it listens. `guarded_at` is the host
    where it wants a token, "" where it listens to this machine only and wants none."""

    pid: int
    started: str
    port: int | None = None
    guarded_at: str = ""


class StateDir:
    """The exclusive owner of a state directory from `open` to `close`, as `with` does it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock: int | None = None
        self._running = Running(
            pid=os.getpid(), started=datetime.now(timezone.utc).isoformat(timespec="seconds")
        )

    def open(self) -> None:
        """Take the directory; StartError says who holds it, or why it cannot be used."""
        try:
            self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
            lock = os.open(self.path / LOCK, os.O_RDWR | os.O_CREAT, 0o600)
        except OSError as error:
            raise StartError(f"The state directory {self.path} cannot be used: {error.strerror}.") from error
        if not take(lock):
            os.close(lock)
            raise StartError(
                f"{holder(self.path)} Stop it first, or give this plant its own --state directory."
            )
        self._lock = lock
        (self.path / FACTS).unlink(missing_ok=True)
        os.ftruncate(lock, 0)
        os.pwrite(lock, json.dumps(asdict(self._running)).encode(), 0)

    def next_epoch(self, unix_s: int) -> int:
        """A number for this start, higher than that of any start before, though the clock was set back."""
        file = self.path / EPOCH
        last = int(file.read_text()) if file.exists() else 0
        epoch = max(unix_s, last + 1)
        replace_file(file, str(epoch))
        return epoch

    def announce(self, port: int, guarded_at: str = "") -> None:
        """Say where the HTTP API listens, and whether it wants a token."""
        known = replace(self._running, port=port, guarded_at=guarded_at)
        replace_file(self.path / FACTS, json.dumps(asdict(known)))

    def close(self) -> None:
        """Give the directory back; idempotent. The lock file stays: removing it would let two owners in."""
        if self._lock is not None:
            (self.path / FACTS).unlink(missing_ok=True)
            os.close(self._lock)
            self._lock = None

    def __enter__(self) -> StateDir:
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def replace_file(file: Path, content: str) -> None:
    """The file appears with all of its content, readable by its owner only."""
    fresh = file.with_name(f".{file.name}.{os.getpid()}")
    with os.fdopen(os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as opened:
        opened.write(content)
    os.replace(fresh, file)


def find_running(path: Path) -> Running | None:
    """Who runs a plant on `path`; None if nobody does, whatever a killed one left behind."""
    try:
        lock = os.open(path / LOCK, os.O_RDONLY)
    except OSError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return read_facts(path / FACTS) or read_facts(path / LOCK)
    finally:
        os.close(lock)
    return None


def read_facts(file: Path) -> Running | None:
    """What the file says, None where it is absent or half written."""
    try:
        return Running(**json.loads(file.read_bytes()))
    except (OSError, ValueError, TypeError):
        return None


def holder(path: Path) -> str:
    """One sentence on who holds the directory."""
    running = read_facts(path / LOCK)
    who = f"process {running.pid}, since {running.started}" if running else "another process"
    return f"A plant is already running on {path} ({who})."


def take(lock: int) -> bool:
    """Whether the exclusive lock was free."""
    for attempt in range(LOCK_TRIES):
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if attempt + 1 < LOCK_TRIES:
                time.sleep(LOCK_PAUSE_S)
        else:
            return True
    return False
