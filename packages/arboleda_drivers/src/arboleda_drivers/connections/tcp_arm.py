"""Arms of six joints behind TCP connections: what their controllers have in common."""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.drivers import Arm, MotionState, Robot

from .controller import Controller
from .link import LinkBroken

SILENT_S = 1.0  # without a new frame
SETTLE_S = 0.3  # an arm that has not moved for so long stands still
CLOCK_S = 2  # the moment of switching on is known to this


class ArmController(Controller):
    """Controller of one arm, which sends frames all the time, and is told what to do beside them."""

    def __init__(self, devices: Sequence[Robot], *, host: str, kind: str) -> None:
        """Raises ValueError unless the device is one arm of six joints; `kind` names the controller."""
        if len(devices) != 1 or not isinstance(devices[0], Arm) or len(devices[0].joints) != 6:
            raise ValueError(f"{kind} is one arm of six joints")
        super().__init__(devices[0], peer=host, kind=kind)
        self.boot = Boot()

    def forget(self, now: float) -> None:
        self.braking = Braking()
        self.frame_at = now  # the time (s) of the last new frame

    def check_silence(self, now: float) -> None:
        """Raises LinkBroken where no new frame has come for too long."""
        if now >= self.frame_at + SILENT_S:
            raise LinkBroken(f"its feedback has stood still for {SILENT_S:g} s")

    def shown(self, state: MotionState, *, readies: bool) -> MotionState:
        """The state for the plant of an arm in this one; `readies`: it is being made ready."""
        if state is MotionState.FAULT and readies:
            return MotionState.NOT_HOMED
        if state is MotionState.FAULT and self.is_latched:
            return MotionState.STOP_LATCHED  # so that the stop can be cleared, and the fault after it
        if state is not MotionState.STOPPED:
            return state
        if self.is_busy or self.braking.is_under_way:
            return MotionState.MOVING  # it may begin to move at any moment, or has not come to rest
        return MotionState.STOP_LATCHED if self.is_latched else state


class Braking:
    """Stop that is under way until the arm stands still, and how long it has stood."""

    def __init__(self) -> None:
        self._since: float | None = None  # inf: the stop is not answered yet
        self._rest_since: float | None = None

    @property
    def is_under_way(self) -> bool:
        return self._since is not None

    def begin(self, since: float = math.inf) -> None:
        """An arm is told to stop; `since` is the time (s) of its answer, inf where it has not come yet."""
        self._since = since

    def end(self) -> None:
        self._since = None

    def see(self, now: float, *, still: bool, broken: bool) -> bool:
        """True where a stop has ended; an arm that is broken off stands still at once."""
        self._rest_since = (self._rest_since or now) if still else None
        if self._since is None:
            return False
        rests = self._rest_since is not None and now - max(self._rest_since, self._since) >= SETTLE_S
        if rests or broken:
            self.end()
        return rests or broken


class Boot:
    """The time (s) at which a controller was switched on, by its own words."""

    def __init__(self) -> None:
        self.at = 0.0
        self._ran: float | None = None

    def see(self, at: float, ran: float, *, after_silence: bool) -> bool:
        """True where a controller that has run for so long was switched on anew since its last frame.

        After a silence it may have run longer than before.
        """
        shifted = after_silence and abs(at - self.at) > CLOCK_S
        booted = self._ran is not None and (ran < self._ran or shifted)
        if self._ran is None or booted:
            self.at = at
        self._ran = ran
        return booted
