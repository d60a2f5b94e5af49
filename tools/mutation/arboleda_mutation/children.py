"""Child processes of a warm one: each does one piece of work, says what came of it, and is gone."""

from __future__ import annotations

import ctypes
import gc
import json
import os
import resource
import selectors
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Generic, TypeVar

Say = Callable[[dict[str, Any]], None]
Work = Callable[[Say], dict[str, Any]]
T = TypeVar("T")

MEMORY_BYTES = 4 * 2**30
SILENT_S = 900.0  # of the clock on the wall; a bound for a child that waits for ever and computes nothing
PR_SET_PDEATHSIG = 1  # prctl(2)


@dataclass
class Ended:
    """Last answer of a child, or the signal that ended it; `at` is what it was at by then."""

    answer: dict[str, Any] | None
    signal: int | None
    at: str
    cpu_s: float


@dataclass
class _Child(Generic[T]):
    task: T
    pid: int
    pipe: int
    last_word_at: float
    raw: bytearray = field(default_factory=bytearray)


class Children(Generic[T]):
    """At most `jobs` of them at a time; inside a `with` block, whose end ends them."""

    def __init__(self, jobs: int, log: Path) -> None:
        self._jobs = jobs
        self._log = log
        self._selector = selectors.DefaultSelector()
        self._alive: dict[int, _Child[T]] = {}

    def __enter__(self) -> Children[T]:
        return self

    def __exit__(self, *_: object) -> None:
        for child in self._alive.values():
            os.killpg(child.pid, signal.SIGKILL)
            os.waitpid(child.pid, 0)
        self._alive.clear()
        self._selector.close()

    def run(self, tasks: Iterable[tuple[T, Work]]) -> Iterator[tuple[T, Ended]]:
        """Each task with what came of it, in the order in which they end."""
        waiting = iter(tasks)
        for task, work in waiting:
            self._begin(task, work)
            while len(self._alive) >= self._jobs:
                yield from self._ended()
        while self._alive:
            yield from self._ended()

    def _begin(self, task: T, work: Work) -> None:
        reader, writer = os.pipe()
        pid = os.fork()
        if pid == 0:
            os.close(reader)
            _do(work, writer, self._log)
        os.setpgid(pid, pid)  # as the child does: whoever is first
        os.close(writer)
        child = _Child(task, pid, reader, time.monotonic())
        self._alive[pid] = child
        self._selector.register(reader, selectors.EVENT_READ, child)

    def _ended(self) -> Iterator[tuple[T, Ended]]:
        for key, _ in self._selector.select(timeout=1.0):
            child: _Child[T] = key.data
            chunk = os.read(child.pipe, 65536)
            child.raw += chunk
            child.last_word_at = time.monotonic()
            if not chunk:
                yield child.task, self._bury(child)
        for child in list(self._alive.values()):
            if time.monotonic() - child.last_word_at > SILENT_S:
                os.killpg(child.pid, signal.SIGKILL)

    def _bury(self, child: _Child[T]) -> Ended:
        self._selector.unregister(child.pipe)
        os.close(child.pipe)
        _, status, used = os.wait4(child.pid, 0)
        del self._alive[child.pid]
        lines = [json.loads(line) for line in child.raw.splitlines() if line.endswith(b"}")]
        at = next((line["at"] for line in reversed(lines) if "at" in line), "")
        answer = lines[-1] if lines and "at" not in lines[-1] else None
        number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else None
        return Ended(answer, number, at, round(used.ru_utime + used.ru_stime, 2))


def _do(work: Work, pipe: int, log: Path) -> None:
    """Never returns."""
    try:
        os.setpgid(0, 0)  # Ctrl-C is for the parent, who ends us
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        _be_quiet(log)
        gc.freeze()  # what the parent has made is no garbage of ours

        def say(line: dict[str, Any]) -> None:
            os.write(pipe, json.dumps(line).encode() + b"\n")

        say(work(say))
    except BaseException:  # noqa: BLE001 - whatever it is, the parent sees that nothing was said
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)


def _be_quiet(log: Path) -> None:
    """Print to a file from now on."""
    sys.stdout.flush()
    file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    null = os.open(os.devnull, os.O_RDONLY)
    for target, number in ((null, 0), (file, 1), (file, 2)):
        os.dup2(target, number)
