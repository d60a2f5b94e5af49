"""Valid numbers of a plant's start: the Unix time of the start, or one above the last number.

Boards and bridges obey the highest number that they have heard, and no lower one after it. So one number far
in the future, by a wrong clock or a forged beat, would lock all later starts out. Hence these limits.
"""

from __future__ import annotations

import math

AHEAD_S = 366 * 86_400  # clocks of two machines differ by no more where both have ever learned the time
BELIEVED_S = 3.0  # after it a plant that goes on beating is taken for one, whatever the clock here shows
GAP_S = 2.0  # between beats of a plant that goes on
HORIZON = 4_102_444_800  # the year 2100: no plant of this protocol starts later, whatever a clock shows


def can_follow(epoch: int, newest_heard: int | None) -> bool:
    """True if a board without a clock accepts `epoch`; `newest_heard` is None before any."""
    return epoch <= (HORIZON if newest_heard is None else min(newest_heard + AHEAD_S, HORIZON))


def objection(epoch: int, unix_s: int | None) -> str | None:
    """The reason why no plant can have started at `epoch`, by a clock that shows `unix_s`; None if one can.

    Without a clock only the horizon counts, so that a machine that forgot the time can still run a bridge.
    """
    if epoch <= (HORIZON if unix_s is None else min(unix_s + AHEAD_S, HORIZON)):
        return None
    here = "" if unix_s is None else f"; the clock here says {unix_s}, set both clocks if that is wrong"
    return f"a heartbeat of plant {epoch} is refused: no plant has started so far in the future{here}"


class FarAhead:
    """A plant whose number is far ahead of the clock here, as after its first start by a wrong clock.

    Its later starts have numbers above, also by a right clock, so that it would be refused for ever. It is
    believed once it has gone on beating for BELIEVED_S, where no plant was heard whose number fits the clock:
    a single stray beat must not have boards refuse their plant. So is each later start of it. Where several
    such plants beat, the newest is meant.
    """

    def __init__(self) -> None:
        self._epoch = 0
        self._since = self._last = -math.inf

    def objection(self, epoch: int, unix_s: int | None, *, heard: int, at: float) -> str | None:
        """The reason not to believe a beat that came at `at`; None to believe it.

        `heard` is the newest number that was believed, 0 before any.
        """
        why = objection(epoch, unix_s)
        if why is None or epoch <= heard:
            return None
        if not can_follow(epoch, heard or None) or (heard and objection(heard, unix_s) is None):
            return why
        return None if self._goes_on(epoch, at) else why

    def _goes_on(self, epoch: int, at: float) -> bool:
        """True once this plant has beaten for BELIEVED_S, and no newer one beats."""
        is_going_on = at - self._last <= GAP_S
        if is_going_on and epoch < self._epoch:
            return False
        if not is_going_on or epoch > self._epoch:
            self._epoch, self._since = epoch, at
        self._last = at
        return at - self._since >= BELIEVED_S
