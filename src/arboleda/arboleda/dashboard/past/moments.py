"""Moments of a record: ms of Unix time, which a browser can tell apart and an address can say."""

from __future__ import annotations

import math
import time

BESIDE_NS = 1000  # more than a float of Unix time in seconds is beside what it stands for


def moment_of(unix_s: float) -> int:
    """The first that is not before."""
    return math.ceil(unix_s * 1000 - BESIDE_NS / 1e6)


def nanoseconds(unix_s: float) -> int:
    """A time of an event."""
    return round(unix_s * 1e6) * 1000


def until_ns(moment: int) -> int:
    """What was told by then was told up to this."""
    return moment * 1_000_000 + BESIDE_NS


def address(moment: int) -> str:
    """As the page's address has it: Unix time in s."""
    return f"{moment / 1000:.3f}"


def dated(moment: int) -> str:
    """Date, time and ms, as the clock on the wall had it."""
    seconds = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(moment // 1000))
    return f"{seconds}.{moment % 1000:03}"
