"""Filter for log lines that would repeat too often."""

from __future__ import annotations

import math
from collections.abc import Hashable

EVERY_S = 5.0
REMEMBERED = 200  # limit of remembered words, so that a stranger cannot fill the memory


class RateLimit:
    """Filter that lets the same words through once in `every_s`; inf for once and never again."""

    def __init__(self, every_s: float = EVERY_S) -> None:
        self._every_s = every_s
        self._last: dict[Hashable, float] = {}

    def is_due(self, words: Hashable, now: float) -> bool:
        """True if these words may be logged at `now` (s): they were not let through in the time before."""
        if now - self._last.get(words, -math.inf) < self._every_s:
            return False
        if len(self._last) >= REMEMBERED:
            self._last.clear()
        self._last[words] = now
        return True
