"""Goal at an action server, and the detector of rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

SETTLE_S = 0.3  # values that stand still for this time are at rest
REST = 0.002  # rad or m; less than this is the noise of an encoder


@dataclass(kw_only=True)
class Goal:
    """Progress of a command; with `stopped` the plant wants it over and waits for its end no more.

    `parts` are what the server is sent for it, one after the other; at `over_at` the plant has given it up.
    At `unknown_at` the server, which had accepted it, said that it knows of no such goal.
    """

    id: str
    parts: tuple[Any, ...]
    sent_at: float
    over_at: float = math.inf
    part: int = 0
    accepted: bool = False
    stopped: bool = False
    succeeded_at: float | None = None
    unknown_at: float | None = None

    @property
    def key(self) -> str:
        """The name of the part that was sent last."""
        return f"{self.id}.{self.part}" if self.part else self.id

    @property
    def what(self) -> Any:
        return self.parts[self.part]

    @property
    def is_at_last_part(self) -> bool:
        return self.part + 1 == len(self.parts)

    def advance(self, now: float) -> bool:
        """Begin the next part; False if there is none."""
        if self.is_at_last_part:
            return False
        self.part, self.sent_at, self.accepted, self.succeeded_at = self.part + 1, now, False, None
        return True


class Rest:
    """Detector of standstill: values rest while they stay within `within` of where they were SETTLE_S ago."""

    def __init__(self, within: float = REST) -> None:
        self._within = within
        self._anchor: tuple[float, ...] | None = None
        self._since = 0.0

    def look(self, now: float, values: Sequence[float]) -> None:
        anchor = self._anchor
        if anchor is None or any(abs(a - b) > self._within for a, b in zip(anchor, values, strict=True)):
            self._anchor, self._since = tuple(values), now

    def holds(self, now: float, since: float = 0.0) -> bool:
        """True if the values have rested for SETTLE_S up to `now`, all of it after `since` (s)."""
        return self._anchor is not None and now - max(self._since, since) >= SETTLE_S
