"""The clock of a running plant."""

from __future__ import annotations

import time

BOOT = getattr(time, "CLOCK_BOOTTIME", None)  # Linux


def seconds() -> float:
    """Seconds that never go back; they pass while the machine is suspended, where the system counts that.

    Linux does, by CLOCK_BOOTTIME; `time.monotonic` stands still there until the machine wakes up.
    """
    return time.monotonic() if BOOT is None else time.clock_gettime(BOOT)
