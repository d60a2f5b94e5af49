"""Filter for log lines that would repeat too often."""

from __future__ import annotations

from collections.abc import Hashable

EVERY_S = 5.0
REMEMBERED = 200  # limit of remembered words, so that a stranger cannot fill the memory


class RateLimit:
    """Filter that lets the same words through once in EVERY_S."""

    def __init__(self) -> None:
        self._last: dict[Hashable, float] = {}

    def is_due(self, words: Hashable, now: float) -> bool:
        """True if these words may be logged at `now` (s): they were not let through in the EVERY_S before."""
        if now - self._last.get(words, -EVERY_S) < EVERY_S:
            return False
        if len(self._last) >= REMEMBERED:
            self._last.clear()
        self._last[words] = now
        return True
