"""Moments of a record: ms of Unix time, which a browser can tell apart and an address can say."""

from __future__ import annotations

import math
import time

BESIDE_NS = 1000  # more than the rounding error of Unix time in seconds as a float


def moment_of(unix_s: float) -> int:
    """The first moment that is not before a time in s."""
    return math.ceil(unix_s * 1000 - BESIDE_NS / 1e6)


def nanoseconds(unix_s: float) -> int:
    """The time of an event, given in s, in ns."""
    return round(unix_s * 1e6) * 1000


def until_ns(moment: int) -> int:
    """The time, in ns, up to which events belong to a moment."""
    return moment * 1_000_000 + BESIDE_NS


def address(moment: int) -> str:
    """The moment as the page's address has it: Unix time in s."""
    return f"{moment / 1000:.3f}"


def dated(moment: int) -> str:
    """The moment with its date, time and ms, in this machine's time zone."""
    seconds = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(moment // 1000))
    return f"{seconds}.{moment % 1000:03}"
