"""A number that changes as long as the program of a PLC runs."""

from __future__ import annotations

from .plc_snapshot import UnreadableValue


class ProgramWatch:
    """A PLC whose program stands still goes on to answer, with values of then: this notices it."""

    def __init__(self, patience_s: float) -> None:
        self._patience_s = patience_s
        self._changed: tuple[int | float, float] | None = None

    def begin(self) -> None:
        """Forget what was seen: a new connection."""
        self._changed = None

    def see(self, at: float, place: str, number: int | float) -> None:
        """Take note of the number; Unreadable where it has not changed for too long."""
        if self._changed is None or self._changed[0] != number:
            self._changed = (number, at)
        elif at - self._changed[1] > self._patience_s:
            what = f"{place} is {number} for {self._patience_s:g} s"
            raise UnreadableValue(f"the program of the PLC stands still: {what}")
