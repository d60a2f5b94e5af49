"""Rivals: other bridges and MQTT clients that command one board, and which of two bridges yields.

MQTT carries no sender: a rival shows only in the numbers that the board says it has taken. The bridge that
was first rises above these numbers, a later bridge yields. A bridge whose plant leads by a lease never
yields: the rival is a process whose lease has ended, and it may rise once more before it ends.
"""

from __future__ import annotations

from collections import deque
from enum import Enum

from .labels import Labels

NEW_S = 10.0  # a bridge that has led its board for less time counts as the later one
MOST, WITHIN_S = 3, 60.0  # limit of rises: a board with false reports would cause them without end


class News(Enum):
    """News of rivals in a board's telemetry."""

    BEATEN = "beaten"  # another bridge beats with a higher number
    YIELDED = "yielded"  # another bridge was there first, so this bridge yields the board
    TAKEN = "taken"  # the board accepted a command that this bridge did not give


class Rivals:
    """Detector of rivals of one board.

    `noticed_at` is when a rival came, None once it is answered. `yielded`: this bridge leaves the board to
    another bridge until it restarts. With `has_lease` it never does.
    """

    def __init__(self, *, has_lease: bool = False) -> None:
        self.yielded = False
        self._has_lease = has_lease
        self._led_since: float | None = None
        self.noticed_at: float | None = None
        self._beaten_by: int | None = None
        self._moves = False  # True if the board may be carrying out somebody else's command
        self._risen: deque[float] = deque(maxlen=MOST)

    def lose(self) -> None:
        """Forget since when this bridge leads: after an absence it does not know which bridge was first."""
        self._led_since = None

    def hear(self, at: float, labels: Labels) -> News | None:
        """The news of rivals in the telemetry that `labels` has just taken; None where there is none."""
        beaten_before, self._beaten_by = self._beaten_by, labels.beaten_by
        if labels.leads and self._led_since is None:
            self._led_since = at
        if labels.foreign is not None:
            self.noticed_at, self._moves = at, True
            return News.TAKEN
        if self._beaten_by in (None, beaten_before) or self.yielded:
            return None
        self.noticed_at = at
        self.yielded = self._beaten_by == labels.epoch + 1 and self._is_new(at)
        return News.YIELDED if self.yielded else News.BEATEN

    def answer(self, at: float, labels: Labels, *, in_motion: bool) -> bool:
        """Rise above the rivals once a later message shows that the plant still commands.

        True if the board is to be halted. The bridge does not rise during a motion of its own: the board
        would end the motion without heartbeats of its epoch.
        """
        noticed, moves = self.noticed_at, self._moves
        if noticed is None or at < noticed or self.yielded or (in_motion and not moves):
            return False
        self.noticed_at, self._moves = None, False
        if len(self._risen) == MOST and at < self._risen[0] + WITHIN_S:
            return False
        self._risen.append(at)
        labels.rise()
        return moves

    def _is_new(self, at: float) -> bool:
        return not self._has_lease and (self._led_since is None or at < self._led_since + NEW_S)
