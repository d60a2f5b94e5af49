"""A goal that the controller was sent, and whether the arm rests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

SETTLE_S = 0.3  # an arm that has not moved for so long is at rest
REST = 0.002  # rad or m; less than this is the noise of an encoder


@dataclass(kw_only=True)
class Goal:
    """What became of it so far; `stopped`: nobody waits for its end any more, the plant wants it over."""

    id: str
    q: tuple[float, ...]
    sent_at: float
    accepted: bool = False
    stopped: bool = False
    succeeded_at: float | None = None


class Rest:
    """Whether joints stand still: they stay within REST of where they were SETTLE_S ago."""

    def __init__(self) -> None:
        self._anchor: tuple[float, ...] | None = None
        self._since = 0.0

    def look(self, now: float, q: Sequence[float]) -> None:
        anchor = self._anchor
        if anchor is None or any(abs(a - b) > REST for a, b in zip(anchor, q, strict=True)):
            self._anchor, self._since = tuple(q), now

    def holds(self, now: float, since: float = 0.0) -> bool:
        """Whether they have rested for SETTLE_S by now, all of it after `since`."""
        return self._anchor is not None and now - max(self._since, since) >= SETTLE_S
