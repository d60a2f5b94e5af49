"""Valid numbers of a plant's start: the Unix time of the start, or one above the last number."""

from __future__ import annotations

AHEAD_S = 366 * 86_400  # clocks of two machines differ by no more where both have ever learned the time
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
