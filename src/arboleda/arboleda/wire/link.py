"""Link to a board: broker, presence, fresh telemetry, and detection of reboots.

Presence and telemetry may contradict each other, as they come by different ways. Telemetry soon after an
absence was on its way before it; a board that goes on talking has not told its presence. A lower number is of
an overtaken message, unless lower numbers go on rising: then the counter has begun anew.
"""

from __future__ import annotations

import math
from collections import deque
from enum import Enum

from .payloads import Telemetry


class LinkUpdate(Enum):
    """Meaning of a telemetry message for the link."""

    LATE = "late"  # it left the broker before the connection was lost
    ABSENT = "absent"  # the board's presence says that nobody is there
    DENIED = "denied"  # the presence says so, but the board goes on talking; reported once
    TWINS = "twins"  # two boards of one name talk in turn; reported once
    OLD = "old"  # overtaken by a newer one of the same boot
    NEWS = "news"
    ARRIVAL = "arrival"  # the link came up with it
    REBOOT = "reboot"  # so did another boot of the board


DENIED_S = 2.0  # after an absence; older messages have arrived by then
TWINS, TWINS_S = 3, 10.0  # so many returns to an earlier boot in this time (s): no board boots into one again
BOOTS = 8  # that are remembered


class BoardLink:
    """State of the link: up with the broker reached, presence not "0", and telemetry within `stale_after_s`.

    With `stale_after_s` None, telemetry of any age counts. `stale_at` is the time at which silence is too
    long; inf while the board does not talk, and where silence means nothing.
    """

    def __init__(self, stale_after_s: float | None) -> None:
        self.up = False
        self.stale_at = math.inf
        self.boot_id: int | None = None
        self._stale_after_s = math.inf if stale_after_s is None else stale_after_s
        self._connected = False
        self.returns = 0  # returns of an absent board; without ids each counts as a boot
        self._absent_since: float | None = None
        self._denied = False  # the board talks, though its presence says that nobody is there
        self._twins = False  # two boards talk in turn
        self._earlier: deque[int | None] = deque(maxlen=BOOTS)  # boots before this one
        self._returned_at: deque[float] = deque(maxlen=TWINS)  # when an earlier one talked again
        self.number: int | None = None  # of the last telemetry, counted since boot
        self._below: tuple[float, int] | None = None  # since when lower numbers rise, and the last of them

    def connection(self, up: bool) -> None:
        self._connected = up
        self._absent_since = None  # the broker tells the retained presence again at the next subscription

    def presence(self, at: float, online: bool) -> None:
        """Take the presence of a board; a board that never sends its presence counts as present."""
        if not online:
            self._absent_since = at if self._absent_since is None else self._absent_since
        elif self._absent_since is not None:
            self.returns += 1
            self._absent_since = None
            self._denied = False

    def lose(self) -> bool:
        """Lose the board, also one that talks although it counts as absent; True if that is new."""
        was_heard = self.up or self._denied or self._twins
        self.up, self._denied, self._twins, self.stale_at, self._below = False, False, False, math.inf, None
        return was_heard

    def hear(self, at: float, telemetry: Telemetry) -> LinkUpdate:
        """Take a telemetry message, and return its meaning for the link."""
        if not self._connected:
            return LinkUpdate.LATE
        if self._absent_since is not None:
            return self._hear_absent(at, self._absent_since)
        if self._overtaken(telemetry) and not self._counts_anew(at, telemetry.seq):
            return LinkUpdate.OLD
        rebooted = telemetry.boot_id != self.boot_id and None not in (telemetry.boot_id, self.boot_id)
        if rebooted:
            self._note_boot(at, telemetry.boot_id)
        self.stale_at = at + self._stale_after_s
        self.number = telemetry.seq
        self.boot_id = self.boot_id if telemetry.boot_id is None else telemetry.boot_id
        if len(self._returned_at) == TWINS and at - self._returned_at[0] <= TWINS_S:
            was_said, self._twins, self.up = self._twins, True, False
            return LinkUpdate.LATE if was_said else LinkUpdate.TWINS
        arrived, self.up = not self.up, True
        were_twins, self._twins = self._twins, False
        if rebooted or were_twins:  # after twins nobody knows what the board has heard
            return LinkUpdate.REBOOT
        return LinkUpdate.ARRIVAL if arrived else LinkUpdate.NEWS

    def _note_boot(self, at: float, boot_id: int | None) -> None:
        if boot_id in self._earlier:
            self._returned_at.append(at)
        self._earlier.append(self.boot_id)

    def _hear_absent(self, at: float, since: float) -> LinkUpdate:
        if at - since < DENIED_S:
            return LinkUpdate.ABSENT
        was_denied, self._denied = self._denied, True
        self.stale_at = at + self._stale_after_s
        return LinkUpdate.ABSENT if was_denied else LinkUpdate.DENIED

    def hear_again(self, at: float, seq: int) -> bool:
        """Take telemetry that repeats the last one; True if it is certainly newer, else `hear` decides."""
        if not self.up:
            return False
        if self.number is not None:
            if seq <= self.number:
                return False
            self.number = seq
        self.stale_at = at + self._stale_after_s
        return True

    def _overtaken(self, telemetry: Telemetry) -> bool:
        if telemetry.boot_id is None or telemetry.boot_id != self.boot_id:
            return False
        return telemetry.seq is not None and self.number is not None and telemetry.seq <= self.number

    def _counts_anew(self, at: float, seq: int | None) -> bool:
        """True if a lost board's lower numbers have risen for `stale_after_s`: then the higher one was wrong.

        Else the board would not be heard for long, after a damaged number or a counter that began anew.
        """
        if self.up or seq is None:
            return False
        since, last = self._below or (at, seq)
        since = since if seq >= last else at
        self._below = since, seq
        return at - since >= self._stale_after_s
