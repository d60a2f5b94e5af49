"""Check that a command is not old: its sender must have heard the board lately, wherever it waited since."""

from __future__ import annotations

from collections import deque

from arboleda.model.commands import FRESH_S

FRESH_US = round(FRESH_S * 1e6)
MARK_US = 250_000  # the resolution of a board's memory of telemetry times


class Freshness:
    """Numbers of the board's telemetry of the last FRESH_US, as marks (time, number) about MARK_US apart.

    A command with an older number, or with one not sent since the boot, has waited: in a broker, in the queue
    of a connection that was cut, or in a process that was stopped.
    """

    def __init__(self) -> None:
        self._marks: deque[tuple[int, int]] = deque(maxlen=FRESH_US // MARK_US)
        self._last_number = 0

    def tell(self, now_us: int, number: int) -> None:
        """Note that telemetry of this number leaves."""
        self._last_number = number
        if not self._marks or now_us - self._marks[-1][0] >= MARK_US:
            self._marks.append((now_us, number))

    @property
    def marks(self) -> tuple[tuple[int, int], ...]:
        """The marks, oldest first."""
        return tuple(self._marks)

    def covers(self, now_us: int, number: int) -> bool:
        """True if telemetry of this number left within FRESH_US."""
        first = next((report for at_us, report in self._marks if now_us - at_us <= FRESH_US), None)
        return first is not None and first <= number <= self._last_number
