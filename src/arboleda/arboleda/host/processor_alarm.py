"""Alarm that ends this process once it took too much processor time, and writes the line that it was at."""

from __future__ import annotations

import faulthandler
import signal
from typing import TextIO

NUMBER: int | None = getattr(signal, "SIGPROF", None)  # None: such time is not watched here, only the clock


class ProcessorAlarm:
    """One alarm of this process. `stack` takes the lines; then the signal's own action ends the process."""

    def __init__(self, stack: TextIO) -> None:
        if NUMBER is not None:
            faulthandler.register(NUMBER, file=stack, chain=True)

    def set(self, seconds: float) -> None:
        """Begin anew with so much processor time; 0: none."""
        if NUMBER is not None:
            signal.setitimer(signal.ITIMER_PROF, seconds)

    def close(self) -> None:
        if NUMBER is not None:
            self.set(0.0)
            faulthandler.unregister(NUMBER)


def ended_by_alarm(status: int | None) -> bool:
    """True if this is the exit status of a process that its alarm has ended."""
    return NUMBER is not None and status == -NUMBER
