"""Work of the arm: a move, or the steps that make it ready; each finds its own end in the frames."""

from __future__ import annotations

import math

from arboleda_drivers.connections.receipts import NOTHING, Look
from arboleda_drivers.connections.tcp_arm import SETTLE_S

from .arm_state import PROTECTIVE_STOP, Mode, Runtime, hindrance, safety_word
from .rtde import Frame

BEGIN_S = 2.0  # a controller begins a program within this time
STEP_S = 20.0  # limit of one step to readiness; a protective stop lasts 5 s at least
AGAIN_S = 1.0  # between two tries to unlock a protective stop
UNLOCK = ("stop", "close safety popup", "unlock protective stop")  # stopped, so that nothing is resumed
STEPS: dict[int, tuple[str, ...]] = {Mode.POWER_OFF: ("power on",), Mode.IDLE: ("brake release",)}
"""The lines to the dashboard that lead out of a mode, on the way to one in which the arm can move."""


class Move:
    """Program of one move: it has ended once it names itself at its end, and no program runs any more."""

    def __init__(self, id: str, number: int, before: Frame, now: float) -> None:
        self.id, self.number = id, number
        self.begun = False
        self.error = ""  # of the controller, about the program
        self._named_before, self._sent_at = before.begun, now
        self._since = math.inf  # when the program was found stopped, or at its end and not stopped

    def look(self, now: float, frame: Frame) -> Look:
        if word := hindrance(frame):
            return Look(failed=word)
        if frame.begun != self.number:
            return self._look_for_begin(now, frame)
        if not self.begun:
            self.begun = True
            return Look(accepted=True)
        stopped, ended = frame.runtime == Runtime.STOPPED, frame.done == self.number
        if stopped and ended:
            return Look(done=True)
        if not stopped and not ended:
            self._since = math.inf
            return NOTHING
        self._since = min(self._since, now)
        if now - self._since <= SETTLE_S:
            return NOTHING  # states and registers need not change in the same frame
        return Look(failed=f"program_stopped {self.error}".strip() if stopped else "another_program_runs")

    def _look_for_begin(self, now: float, frame: Frame) -> Look:
        if self.begun or frame.begun != self._named_before:
            return Look(failed="another_program_runs")
        if self.error:
            return Look(failed=f"program_refused {self.error}")
        return Look(failed="not_begun") if now - self._sent_at > BEGIN_S else NOTHING


class Readying:
    """Steps to readiness: unlock a protective stop, power the arm, release its brakes. Nothing moves."""

    begun = True

    def __init__(self, id: str, now: float) -> None:
        self.id = id
        self.reply = ""  # the dashboard's last one
        self._step: tuple[int, int, int] | None = None
        self._since = self._requested_at = now

    def look(self, now: float, frame: Frame) -> Look:
        step = (frame.safety, frame.mode, frame.runtime)
        first, changed = self._step is None, step != self._step
        if changed:
            self._step, self._since = step, now
        if frame.safety == PROTECTIVE_STOP:
            again = changed or now - self._requested_at > AGAIN_S
            return self._say(now, UNLOCK) if again and not self._is_late(now) else self._wait(now, frame)
        if word := safety_word(frame):
            return Look(failed=word)  # a person ends it, at the robot
        popup = ("close popup",) if first else ()
        if frame.mode != Mode.RUNNING:
            lines = (*popup, *STEPS.get(frame.mode, ()))
            return self._say(now, lines) if changed and lines else self._wait(now, frame)
        if frame.runtime == Runtime.STOPPED:
            return Look(done=True, lines=popup)
        if frame.runtime == Runtime.PLAYING:
            return Look(failed="another_program_runs")
        return self._say(now, (*popup, "stop")) if changed else self._wait(now, frame)

    def _is_late(self, now: float) -> bool:
        return now - self._since > STEP_S

    def _say(self, now: float, lines: tuple[str, ...]) -> Look:
        self._requested_at = now
        return Look(lines=lines)

    def _wait(self, now: float, frame: Frame) -> Look:
        if not self._is_late(now):
            return NOTHING
        word = hindrance(frame) or "not_ready"
        return Look(failed=f"{word} {self.reply}".strip())


Work = Move | Readying
