"""Fork of this process that does one piece of work, as apart as another Python, and there at once."""

from __future__ import annotations

import os
import select
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType

TASKS = "/proc/self/task"


def can_fork() -> bool:
    """True if nothing is lost in a fork of this process: it has one thread, and the system can wait for it.

    A fork has a copy of each lock that another thread holds, and nobody there who releases it. Threads of C
    libraries count too.
    """
    if sys.platform != "linux":
        return False
    try:
        os.close(os.pidfd_open(os.getpid()))
        return len(os.listdir(TASKS)) == 1
    except OSError:
        return False


class Fork:
    """Fork that does `work` without input and output, and ends: with status 0, or 1 where `work` raised.

    What waits for it and ends it is as in `subprocess.Popen`.
    """

    def __init__(self, work: Callable[[], object]) -> None:
        self._pid = os.fork()
        if not self._pid:
            _do(work)
        assert sys.platform == "linux"
        self._end = os.pidfd_open(self._pid)
        self._status: int | None = None

    def __enter__(self) -> Fork:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.wait()
        os.close(self._end)

    def wait(self, timeout: float | None = None) -> int:
        """Its exit status, negative where a signal ended it; subprocess.TimeoutExpired after so many
        seconds."""
        if self._status is None:
            ended, _, _ = select.select([self._end], [], [], timeout)
            if not ended:
                raise subprocess.TimeoutExpired("fork", timeout or 0.0)
            _, status = os.waitpid(self._pid, 0)
            self._status = os.waitstatus_to_exitcode(status)
        return self._status

    def kill(self) -> None:
        """End it at once, if it has not ended."""
        if self._status is None:
            os.kill(self._pid, 9)


def _do(work: Callable[[], object]) -> None:
    """Do the work in the fork, and end it without what this process would do at its own end."""
    status = 1
    with suppress(BaseException):
        null = os.open(os.devnull, os.O_RDWR)
        for each in (0, 1, 2):
            os.dup2(null, each)
        work()
        status = 0
    os._exit(status)
