"""Checks that are made only now and then, or only when what they depend on has changed."""

from __future__ import annotations


class Checked:
    """Time at which each check is due next, and the value for which it was made last."""

    def __init__(self) -> None:
        self._next: dict[str, float] = {}
        self._values: dict[str, object] = {}

    def due_for(self, check: str, now: float, every_s: float) -> bool:
        """True if a check that is made only every `every_s` is due; counts as made then."""
        if now < self._next.get(check, 0.0):
            return False
        self._next[check] = now + every_s
        return True

    def is_new(self, check: str, value: object) -> bool:
        """True if this is another value than when it was asked last; a check that depends on no more than the
        value need not be made again.
        """
        if check in self._values and self._values[check] == value:
            return False
        self._values[check] = value
        return True
