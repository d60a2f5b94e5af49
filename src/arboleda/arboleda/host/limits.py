"""Limits of this process: open files, memory, processor time, and its place behind others; an alarm."""

from __future__ import annotations

import faulthandler
import os
import signal
from contextlib import suppress
from typing import TextIO

try:
    import resource
except ImportError:  # Windows, and a tab of a browser: none of these limits is there
    resource = None  # type: ignore[assignment]

# None: this system watches no processor time of a process, only the clock.
ALARM: int | None = getattr(signal, "SIGPROF", None)
# Python that runs the command `arboleda` at a low priority, with the words of its command line.
BEHIND = (
    "import sys; from arboleda.host.limits import give_way; give_way(10); "
    "from arboleda.cli.main import main; sys.argv[0] = 'arboleda'; main()"
)


def open_files() -> int | None:
    """The number of files that this process may open; None if nothing limits it."""
    if resource is None:
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return None if soft == resource.RLIM_INFINITY else soft


def raise_open_files(wanted: int) -> None:
    """Raise the limit of open files to `wanted`, or as near to it as is possible without being root."""
    soft = open_files()
    if soft is None or resource is None:
        return
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = wanted if hard == resource.RLIM_INFINITY else min(hard, wanted)
    if soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def limit_memory(size: int) -> None:
    """End this process if it takes more than `size` bytes, where the system can do that."""
    if resource is not None:
        with suppress(ValueError, OSError):  # macOS has the name, and refuses it
            resource.setrlimit(resource.RLIMIT_AS, (size, size))


def limit_processor(seconds: int) -> None:
    """End this process after so much time of the processor, where the system can do that."""
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


def give_way(steps: int) -> None:
    """Lower the priority of this process by so many steps of niceness, where the system has them."""
    if hasattr(os, "nice"):
        os.nice(steps)


class ProcessorAlarm:
    """Ends this process once it took too much processor time, after it wrote its stack into `stack`."""

    def __init__(self, stack: TextIO) -> None:
        if ALARM is not None:
            faulthandler.register(ALARM, file=stack, chain=True)

    def set(self, seconds: float) -> None:
        """Allow so much processor time from now on; 0: without a limit."""
        if ALARM is not None:
            signal.setitimer(signal.ITIMER_PROF, seconds)

    def close(self) -> None:
        if ALARM is not None:
            self.set(0.0)
            faulthandler.unregister(ALARM)


def ended_by_alarm(status: int | None) -> bool:
    """True if this is the exit status of a process that its alarm has ended."""
    return ALARM is not None and status == -ALARM
