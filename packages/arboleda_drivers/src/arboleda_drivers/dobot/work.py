"""Work of the arm: a move, or the steps that make it ready; each finds its own end in the feedback frames."""

from __future__ import annotations

import math
from collections.abc import Callable

from arboleda_drivers.connections.receipts import NOTHING, Look
from arboleda_drivers.connections.tcp_arm import SETTLE_S

from .frames import Feedback, Mode

BEGIN_S = 2.0  # an idle controller begins a queued command within this time
STEP_S = 15.0  # limit of one step to readiness; power takes some 10 s, says the maker

ALARM = "alarm"
BROKEN = {
    Mode.ERROR: ALARM,
    Mode.COLLISION: "collision",
    Mode.POWER_OFF: "power_off",
    Mode.DISABLED: "disabled",
    Mode.BRAKE_OPEN: "brake_open",
    Mode.DRAG: "dragged_by_hand",
    Mode.INIT: "starting",
}
"""Modes in which work has broken off, each with the word for the plant."""

STEPS: dict[Mode, tuple[str, ...]] = {
    Mode.ERROR: ("ClearError()",),
    Mode.COLLISION: ("ClearError()",),
    Mode.POWER_OFF: ("PowerOn()",),
    Mode.DISABLED: ("EnableRobot()",),
}
"""The lines that lead out of a mode, on the way to one in which the arm can move."""


class Move:
    """Queued motion command: it ends when the controller names its number as the last one, and idles."""

    def __init__(self, id: str, is_there: Callable[[Feedback], bool]) -> None:
        self.id = id
        self.number: int | None = None  # the controller's number, once it has accepted it
        self._is_there = is_there
        self._taken_at = math.inf
        self._idle_since: float | None = None

    def taken(self, now: float, number: int) -> None:
        self.number, self._taken_at = number, now

    def look(self, now: float, feedback: Feedback) -> Look:
        if feedback.mode in BROKEN:
            return Look(failed=BROKEN[feedback.mode])
        if self.number is None:
            return NOTHING
        if feedback.command > self.number:
            return Look(failed="another_client_moves_it")
        if feedback.mode is not Mode.IDLE:
            self._idle_since = None
            return NOTHING
        self._idle_since = now if self._idle_since is None else self._idle_since
        idle_s = now - max(self._idle_since, self._taken_at)
        if feedback.command != self.number:
            return Look(failed="not_begun") if idle_s > BEGIN_S else NOTHING
        # Idle away from the goal may be the moment before the begin: only an arm that stays so has ended.
        return Look(done=self._is_there(feedback) or idle_s > SETTLE_S)


class Readying:
    """Steps to readiness, as its mode requires: clear alarms, power the arm, enable it."""

    def __init__(self, id: str, now: float) -> None:
        self.id = id
        self._mode: Mode | None = None
        self._since = now

    def look(self, now: float, feedback: Feedback) -> Look:
        if feedback.mode is Mode.IDLE:
            return Look(done=True)
        if feedback.mode is not self._mode:
            self._mode, self._since = feedback.mode, now
            return Look(lines=STEPS.get(feedback.mode, ()))
        if now - self._since > STEP_S:
            return Look(failed=BROKEN.get(feedback.mode, "not_ready"))
        return NOTHING


Work = Move | Readying
