"""The moment that faces are made of: a snapshot and the memory of earlier ones."""

from __future__ import annotations

import time
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..tree_memory import TreeMemory
from ..wording import Words


@dataclass(frozen=True, kw_only=True)
class Moment:
    """A snapshot and what was kept from earlier ones; `unix_s` is the snapshot's time."""

    snapshot: dict[str, Any]
    layout: dict[str, Any]
    links: dict[str, Any]
    trees: Mapping[str, TreeMemory]
    events: Sequence[dict[str, Any]]
    words: Words
    unix_s: float
    failed: Container[str] = ()  # cells of which a failure is in the record

    def unix(self, plant_s: float) -> float:
        """A time of the plant's clock as unix s."""
        return self.unix_s - (float(self.snapshot["at"]) - plant_s)


def clock(unix_s: float) -> str:
    """Hours, minutes and seconds of this machine's time zone."""
    return time.strftime("%H:%M:%S", time.localtime(unix_s))


def dated(unix_s: float, now: float) -> str:
    """The `clock`, after its date if the day is not that of `now`."""
    date, today = (time.strftime("%Y-%m-%d", time.localtime(at)) for at in (unix_s, now))
    return clock(unix_s) if date == today else f"{date} {clock(unix_s)}"


def seconds(value: float | None) -> str:
    """A duration for people: `8 s`, `2:05 min`, `3:07 h`; "" for None."""
    if value is None:
        return ""
    whole = max(0, round(value))
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60}:{whole % 60:02} min"
    return f"{whole // 3600}:{whole // 60 % 60:02} h"
