"""Others who command one board beside this bridge, and which of two bridges goes on.

MQTT carries no sender: another one shows only in the numbers that the board says it has taken. The bridge
that was there first rises above them, the one that came later yields. A bridge whose plant leads by a lease
yields to nobody: another process of the plant, whose lease has ended, may rise once more before it ends.
"""

from __future__ import annotations

from collections import deque
from enum import Enum

from .labels import Labels

NEW_S = 10.0  # a bridge that has led its board for less time came later
MOST, WITHIN_S = 3, 60.0  # limit of rises: a board with false reports would cause them without end


class News(Enum):
    """Trouble with others that a board's telemetry newly shows."""

    BEATEN = "beaten"  # another bridge beats with a higher number
    YIELDED = "yielded"  # it was there first, so this one yields the board
    TAKEN = "taken"  # it accepted a command that this bridge did not give


class Rivals:
    """Detector of others; `noticed_at`: when some came, until they are answered; `yielded`: this bridge
    leaves the board to another one until it restarts; `has_lease`: it never does.
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
        """Forget when this bridge began to lead: after an absence it does not know who came first."""
        self._led_since = None

    def hear(self, at: float, labels: Labels) -> News | None:
        """The news that this telemetry brings of others, None for none; `labels` has taken it in already."""
        known, self._beaten_by = self._beaten_by, labels.beaten_by
        if labels.leads and self._led_since is None:
            self._led_since = at
        if labels.foreign is not None:
            self.noticed_at, self._moves = at, True
            return News.TAKEN
        if self._beaten_by in (None, known) or self.yielded:
            return None
        self.noticed_at = at
        self.yielded = self._beaten_by == labels.epoch + 1 and self._is_new(at)
        return News.YIELDED if self.yielded else News.BEATEN

    def answer(self, at: float, labels: Labels, *, in_motion: bool) -> bool:
        """Rise above the others, if a later word of the plant shows that it still commands; True if the board
        is to be halted.

        Not while a motion goes on that the board would end without heartbeats of its own epoch.
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
