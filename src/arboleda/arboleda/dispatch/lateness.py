"""Lateness that has a board stop by itself: of the plant's heartbeats, or of what is heard of the robot."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from arboleda.model.sentence import Phrase, Sentence

from .ledger import Entry

LATE_S = 0.7  # a board stops 1 s after the last heartbeat, one comes every 0.25 s, and each may be on the way
KEPT = 8  # of the last pauses of one source
SHORT_BECAUSE = Phrase("command.short_because", "{robot}: stopped before its target while {doing}: {late}")
BEATS_LATE = Phrase(
    "why.beats_late",
    "the plant sent no heartbeat for {seconds:.1f} s, and a board stops after 1 s without one",
)
REPORTS_LATE = Phrase(
    "why.reports_late",
    "nothing was heard of it for {seconds:.1f} s: its board, network or broker was late",
)
LATE_ON_THE_WAY = Phrase(
    "why.late_on_the_way",
    "it was heard, and heartbeats left in time: they came late on their way, or something else stopped it",
)


@dataclass
class Pauses:
    """The last long pauses of something that is due all the time: when each ended, and how long it was, s."""

    _long: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=KEPT))

    def note(self, ended_at: float, seconds: float) -> None:
        """Take in a pause of more than LATE_S."""
        self._long.append((ended_at, seconds))

    def longest(self, since: float) -> float:
        """The longest pause that ended since then, s; 0 without any."""
        return max((seconds for ended_at, seconds in self._long if ended_at >= since), default=0.0)


def short_because(entry: Entry, beats: Pauses, reports: Pauses) -> Sentence:
    """The sentence on work that stopped short: with what was late since it was given."""
    if (seconds := beats.longest(entry.sent_at)) > 0.0:
        late = BEATS_LATE(seconds=seconds)
    elif (seconds := reports.longest(entry.sent_at)) > 0.0:
        late = REPORTS_LATE(seconds=seconds)
    else:
        late = LATE_ON_THE_WAY()
    return SHORT_BECAUSE(robot=entry.command.robot, doing=entry.doing, late=late)
