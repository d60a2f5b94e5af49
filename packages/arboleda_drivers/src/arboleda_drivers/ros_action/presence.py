"""Presence of the other ends of a device: servers, publishers, and those who hear what is published."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple
from zlib import crc32

GONE_S = 1.0  # a restarted one is away for a moment, and discovery takes another
NOBODY = {
    "action": "there is no action server {}",
    "service": "there is no service {}",
    "topic": "nobody publishes {}",
    "publish": "nobody listens to {}",
}
SEVERAL = {
    "action": "there are {} action servers {}; one is needed",
    "service": "there are {} services {}; one is needed",
    "topic": "{} publish {}; one is needed",
}


class End(NamedTuple):
    """Other end of a name: an `action`, a `service`, who hears what we `publish`, or a `topic`
    that somebody else publishes."""

    kind: str
    name: str


Found = Mapping[End, tuple[int, ...]]


class Presence:
    """Presence of all ends of one device, each alone; what is published may have many hearers.

    Who answers or publishes has a number that is new after a restart; of a service only how many there are
    is known.
    """

    def __init__(self, ends: Iterable[End]) -> None:
        self._found: dict[End, tuple[int, ...]] = dict.fromkeys(ends, ())
        self._there_at = dict.fromkeys(self._found, -math.inf)
        self._last: dict[End, int] = {}
        self._was_gone: set[End] = set()

    @property
    def boot(self) -> int:
        """A number that changes where one of them is started anew: a server, or without any a publisher."""
        kinds = {end.kind for end in self._last}
        counted = kinds & {"action", "service"} or kinds
        rows = sorted((end, number) for end, number in self._last.items() if end.kind in counted)
        return crc32(repr(rows).encode())

    def find(self, now: float, found: Found) -> list[End]:
        """Note who is there; returns those that were started anew."""
        return [end for end, ids in found.items() if end in self._found and self._see(now, end, ids)]

    def _see(self, now: float, end: End, ids: tuple[int, ...]) -> bool:
        self._found[end] = ids
        if not ids or (len(ids) > 1 and end.kind != "publish"):
            self._was_gone.add(end)
            return False
        self._there_at[end] = now
        if end.kind == "publish":
            return False
        before = self._last.get(end)
        if end.kind == "service":
            number = 0 if before is None else before + (end in self._was_gone)
        else:
            number = ids[0]
        self._was_gone.discard(end)
        self._last[end] = number
        return before not in (None, number)

    def missing(self, now: float) -> str:
        """The sentence on the first end that is not there as it has to be; "" if all are."""
        for end, at in self._there_at.items():
            if now >= at + GONE_S:
                count = len(self._found[end])
                return (
                    SEVERAL[end.kind].format(count, end.name) if count else NOBODY[end.kind].format(end.name)
                )
        return ""
