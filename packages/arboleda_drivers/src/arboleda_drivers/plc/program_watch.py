"""Heartbeat of a PLC: a number that changes as long as its program runs."""

from __future__ import annotations

from .plc_snapshot import UnreadableValue


class ProgramWatch:
    """Check of a PLC's heartbeat: one whose program stands still goes on answering, with old values."""

    def __init__(self, patience_s: float) -> None:
        self._patience_s = patience_s
        self._changed: tuple[int | float, float] | None = None

    def begin(self) -> None:
        """Forget the number seen, for a new connection."""
        self._changed = None

    def see(self, at: float, place: str, number: int | float) -> None:
        """Note the number; raises UnreadableValue if it has not changed for too long."""
        if self._changed is None or self._changed[0] != number:
            self._changed = (number, at)
        elif at - self._changed[1] > self._patience_s:
            what = f"{place} is {number} for {self._patience_s:g} s"
            raise UnreadableValue(f"the program of the PLC stands still: {what}")
