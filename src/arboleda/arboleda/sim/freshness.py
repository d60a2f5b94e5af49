"""Whether a command comes in time: who gave it must have heard the board lately, wherever it waited since."""

from __future__ import annotations

from collections import deque

FRESH_US = 2_000_000
MARK_US = 250_000  # how exactly a board remembers what it told when


class Freshness:
    """What a board has told within FRESH_US, as marks of (time, number of the telemetry) some MARK_US apart.

    A number that it told longer ago, or has not told since its boot, is that of a command which waited: in a
    broker, in the queue of a connection that was cut, in a process that was stopped.
    """

    def __init__(self) -> None:
        self._marks: deque[tuple[int, int]] = deque(maxlen=FRESH_US // MARK_US)
        self._told = 0

    def tell(self, now_us: int, number: int) -> None:
        """Telemetry of this number leaves."""
        self._told = number
        if not self._marks or now_us - self._marks[-1][0] >= MARK_US:
            self._marks.append((now_us, number))

    def covers(self, now_us: int, number: int) -> bool:
        """Whether telemetry of this number left lately."""
        first = next((told for at_us, told in self._marks if now_us - at_us <= FRESH_US), None)
        return first is not None and first <= number <= self._told
