"""Stops of GRBL, and the resets that end them."""

from __future__ import annotations

import math
from enum import Enum, auto
from typing import Any

from arboleda_drivers.connections.receipts import Receipts
from arboleda_drivers.connections.stream import Write

from .controller import Halting
from .grbl_lines import HOLD, RESET, State, Status

SILENT_S = 1.0  # a controller answers a query in milliseconds
RESET_AGAIN_S = 0.5  # a reset that comes while an alarm is being said is lost
RESET_ENDS_S = 2.0
SETTLE_S = 0.5  # one that idles for so long away from its goal has ended there
RESETTABLE = {State.HOLD: (0,), State.DOOR: (0, 1)}  # there nothing moves any more, and the place is kept
IDLE_ENOUGH = (State.ALARM, State.CHECK, State.SLEEP, State.TOOL)  # nothing moves, and nothing is queued


class Step(Enum):
    """Step of a stop, or of the way to readiness."""

    HOLDING = auto()  # until the machine has come to rest
    RESETTING = auto()  # until the controller has begun anew


class GrblStop(Halting[Step]):
    """Stop over one line: the feed is held, and once all stands a reset empties the queue."""

    def __init__(self, out: list[Any], receipts: Receipts, now: float) -> None:
        super().__init__(receipts, now)
        self.is_critical = False  # it hears nothing but a reset
        self._out = out
        self._resets, self._reset_at = 0, -math.inf  # those from here that have not ended yet

    def hold(self, now: float) -> None:
        self.begin(now, Step.HOLDING)
        self._out.append(Write(data=HOLD))

    def reset(self, now: float) -> None:
        self.begin(now, Step.RESETTING)
        self._resets, self._reset_at = self._resets + 1, now
        self._out.append(Write(data=RESET))

    def lead_out(self, now: float) -> None:
        """Reset it, as it hears and says nothing else; it stands, and is locked or not homed after that."""
        self.is_critical = True
        if self.how is not Step.RESETTING:
            self.reset(now)

    def was_asked(self, now: float) -> bool:
        """True where it has begun anew by a reset from here."""
        was_asked = self._resets > 0 and now - self._reset_at < RESET_ENDS_S
        self._resets = self._resets - 1 if was_asked else 0
        self.is_critical = False
        return was_asked

    def go_on(self, now: float, status: Status) -> None:
        """Do the next step by a status."""
        if self.how is Step.RESETTING:
            return
        stands = status.part in RESETTABLE.get(status.state, ())
        late = now - self.since > SETTLE_S
        if stands or status.state in IDLE_ENOUGH or (late and status.state is State.IDLE):
            self.reset(now)
        elif late and status.state not in RESETTABLE:  # where it brakes already, once is enough
            self.hold(now)

    def insist(self, now: float, *, is_silent: bool) -> None:
        """Reset again one that has not begun anew, and one that is silent and does not come to rest."""
        waits_s = now - self.since
        resets = self.how is Step.RESETTING and waits_s > RESET_AGAIN_S
        if resets or (is_silent and self.how is Step.HOLDING and waits_s > SILENT_S):
            self.reset(now)  # what it asks for is the same however often it is said
