"""The pace of commits to a plant's memory: how long they take, and when that is slow."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from statistics import median

from arboleda.model.sentence import Phrase, Sentence

RECENT = 20  # commits whose median counts: some tasks of one cell
LEAST = 5  # fewer commits say nothing about a disk
# A disk that is well takes 0.1 to 30 ms. People notice 0.1 s when they press a button, and a task waits for
# some commits one after the other.
SLOW_S, FAST_S = 0.1, 0.05
# The plant beats from the thread that commits, and boards stop by themselves after 1 s without a beat.
STALL_S = 0.5
STALL_KEPT_S = 60.0  # so long one stall counts, which also keeps the warnings apart
KEPT_S = 600.0  # older commits say nothing of the disk of now

SLOW = Phrase(
    "memory.slow",
    "the plant's memory is slow: whatever needs a commit waits {typical:.2f} s for it now as a rule, and up"
    " to {worst:.2f} s; boards stop by themselves where that adds up to 1 s. Look at the disk, or at the"
    " database and the way to it",
)
FAST = Phrase("memory.fast", "the plant's memory is fast again: a commit takes {typical:.3f} s")


@dataclass(frozen=True, kw_only=True)
class Pace:
    """The time of a commit, typical and worst, and whether that is slow."""

    typical_s: float = 0.0
    worst_s: float = 0.0
    is_slow: bool = False

    @property
    def sentence(self) -> Sentence:
        if self.is_slow:
            return SLOW(typical=self.typical_s, worst=self.worst_s)
        return FAST(typical=self.typical_s)


class CommitPace:
    """Judges commits by a clock that is handed in; once slow, they must be clearly fast again."""

    def __init__(self) -> None:
        self._commits: deque[tuple[float, float]] = deque(maxlen=RECENT)  # when each was over, and its length
        self._stalled_until = 0.0
        self._is_slow = False

    def committed(self, seconds: float, now: float) -> None:
        """Count a commit that is over."""
        self._commits.append((now, seconds))
        if seconds >= STALL_S:
            self._stalled_until = now + STALL_KEPT_S

    def pace(self, now: float, pending_s: float = 0.0) -> Pace:
        """The pace now; `pending_s` is for how long a commit has been under way."""
        while self._commits and now - self._commits[0][0] > KEPT_S:
            self._commits.popleft()
        lengths = [seconds for _, seconds in self._commits]
        typical = median(lengths) if lengths else 0.0
        limit = FAST_S if self._is_slow else SLOW_S
        is_slow = len(lengths) >= LEAST and typical >= limit
        self._is_slow = is_slow or pending_s >= STALL_S or now < self._stalled_until
        return Pace(typical_s=typical, worst_s=max([pending_s, *lengths], default=0.0), is_slow=self._is_slow)
