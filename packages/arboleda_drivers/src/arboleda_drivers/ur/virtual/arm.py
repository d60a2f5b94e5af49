"""Power, brakes and safety of a virtual arm of Universal Robots."""

from __future__ import annotations

import math
from collections.abc import Collection

from arboleda_drivers.ur.arm_state import NORMAL, PROTECTIVE_STOP, Mode

POWER_S, BRAKES_S = 1.0, 0.5  # real ones take some seconds
UNLOCK_S = 5.0  # a protective stop cannot be unlocked earlier
SAFEGUARD, BUTTON = 5, 7


class Arm:
    """Arm that can move where its `mode` is RUNNING and its `safety` NORMAL."""

    def __init__(self, *, running: bool) -> None:
        self.mode = Mode.RUNNING if running else Mode.POWER_OFF
        self.safety = NORMAL
        self.popup = False
        self.goes_on = False  # a paused program may go on
        self._popup_closed = False
        self._protected_at = -math.inf
        self._powered_at = self._released_at = math.inf

    @property
    def next_deadline(self) -> float:
        return min(self._powered_at, self._released_at)

    def boot(self) -> None:
        self.__init__(running=False)  # type: ignore[misc]

    def pass_time(self, now: float, faults: Collection[str]) -> None:
        if self._powered_at <= now:
            self.mode, self._powered_at = Mode.IDLE, math.inf
        if self._released_at <= now:
            self.mode, self._released_at = Mode.RUNNING, math.inf
        if "power_off" in faults or "stop_button" in faults:
            self.mode, self._powered_at, self._released_at = Mode.POWER_OFF, math.inf, math.inf
        if "brakes_stuck" in faults:
            self._released_at = math.inf
        self._popup_closed = self._popup_closed and "popup" in faults
        self.popup = "popup" in faults and not self._popup_closed
        outside = SAFEGUARD if "safeguard" in faults else BUTTON if "stop_button" in faults else NORMAL
        if self.safety != PROTECTIVE_STOP or outside == BUTTON:
            self.goes_on = self.goes_on or (self.safety == SAFEGUARD and outside == NORMAL)
            self.safety = outside

    def protect(self, now: float) -> None:
        """Go into a protective stop."""
        self.safety, self.goes_on, self._protected_at = PROTECTIVE_STOP, False, now

    def unlock(self, now: float) -> bool:
        """Leave a protective stop; False where that is too early."""
        if self.safety == PROTECTIVE_STOP and now < self._protected_at + UNLOCK_S:
            return False
        if self.safety == PROTECTIVE_STOP:
            self.safety = NORMAL
        return True

    def power(self, now: float) -> None:
        if self.mode == Mode.POWER_OFF and self.safety == NORMAL and self._powered_at == math.inf:
            self._powered_at = now + POWER_S

    def release(self, now: float) -> None:
        """Release the brakes, with power first where there is none."""
        if self.safety != NORMAL or self._released_at < math.inf:
            return
        if self.mode in (Mode.IDLE, Mode.POWER_OFF):
            self._released_at = now + BRAKES_S + (POWER_S if self.mode == Mode.POWER_OFF else 0.0)

    def close_popup(self) -> None:
        self._popup_closed = True
        self.popup = False
