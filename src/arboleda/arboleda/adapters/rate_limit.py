"""What is said again and again is logged now and then."""

from __future__ import annotations

from collections.abc import Hashable

EVERY_S = 5.0
REMEMBERED = 200  # words; a stranger must not fill the memory


class RateLimit:
    """Lets the same words through once in EVERY_S."""

    def __init__(self) -> None:
        self._said: dict[Hashable, float] = {}

    def is_due(self, words: Hashable, now: float) -> bool:
        """Whether they were not let through within EVERY_S before `now`, in s."""
        if now - self._said.get(words, -EVERY_S) < EVERY_S:
            return False
        if len(self._said) >= REMEMBERED:
            self._said.clear()
        self._said[words] = now
        return True
