"""Book about the place of a machine with GRBL: whether it counts from a reference, or from anywhere.

GRBL does not say so. A boot has it count from where it stands, and only one that is set to lock itself shows
that after it; so what happened before a line was opened counts only where the controller is set so.
"""

from __future__ import annotations

from arboleda.drivers import Jointed

from .grbl_lines import ASK_LOCK, LOCK_SIGNS, Answer, LockSign, State, Status
from .settings import Settings

ASK_S = 1.0  # for the answers about its lock
LATE_S, REST_LATE_S = 1.0, 0.1  # a status may be so much older than it is heard; at rest that matters less
SLACK_M = 0.002
LOCKED = (State.ALARM, State.HOME)
UNDER_WAY = (State.RUN, State.JOG, State.HOLD, State.DOOR)


class Book:
    """Book about one machine, from the opening of its line to its loss."""

    def __init__(self, robot: Jointed, settings: Settings) -> None:
        self.homed = self.has_jumped = False
        self._robot, self._settings = robot, settings
        self._may_ask = settings.homing  # what happened before the line was opened counts if it locks itself
        self._last: Status | None = None
        self._last_at = 0.0
        self._open_answers, self._asked_at = 0, 0.0
        self._signs: dict[str, bool] = {}
        self._has_sign = False  # since the last answer

    @property
    def is_asking(self) -> bool:
        """True while an answer about its lock is open."""
        return self._open_answers > 0

    @property
    def is_known(self) -> bool:
        """False while it has still to be asked about its lock."""
        return not self._may_ask and not self.is_asking

    def trust(self) -> None:
        """Take it that it counts from its reference: it was homed, or a person says so."""
        self.homed, self.has_jumped, self._may_ask = True, False, False

    def lose(self) -> None:
        """Take it that its place is lost, or that nobody has said where it counts from."""
        self.homed = self.has_jumped = self._may_ask = False
        self._last, self._open_answers = None, 0

    def skip(self) -> None:
        """Compare its next status with none, as it may count from elsewhere then."""
        self._last = None

    def begin(self) -> None:
        """Take it that it began anew: it gives no answer any more, and nobody has unlocked it meanwhile."""
        if self._last is not None and self._last.state in LOCKED:
            self.skip()
        self._may_ask = self._may_ask or self.is_asking
        self._open_answers = 0

    def look(self, now: float, status: Status, *, at_work: bool) -> bool:
        """Take a status; True where the machine cannot have moved there since the last one."""
        last, time_s = self._last, now - self._last_at
        if status.state in LOCKED:
            self.lose()
        elif last is not None and last.state in LOCKED and self._settings.homing:
            self.trust()  # somebody has homed it, or has unlocked it
        elif status.homed is not None and (self._may_ask or not status.homed):
            self.homed, self._may_ask = status.homed, False
        self._last, self._last_at = status, now
        if last is None or last.state in LOCKED or status.state in LOCKED:
            return False
        moves = at_work or last.state in UNDER_WAY or status.state in UNDER_WAY
        has_jumped = self._leaps(last, status, time_s + (LATE_S if moves else REST_LATE_S))
        if has_jumped:
            self.lose()
            self.has_jumped = True
        return has_jumped

    def _leaps(self, last: Status, status: Status, time_s: float) -> bool:
        here, there = self._settings.joints(last.position), self._settings.joints(status.position)
        ways = zip(self._robot.joints, here, there, strict=True)
        return any(abs(b - a) > joint.speed * time_s + SLACK_M for joint, a, b in ways)

    def asks(self, now: float, status: Status) -> bool:
        """True where it is to be asked now whether it locks itself, which it answers while it idles."""
        if self.is_asking and now - self._asked_at > ASK_S:
            self._open_answers = 0
        if not self._may_ask or status.state is not State.IDLE:
            return False
        self._may_ask = False
        self._open_answers, self._asked_at = len(ASK_LOCK), now
        return True

    def take_sign(self, sign: LockSign) -> None:
        """Note what it says of its lock, if it was asked."""
        self._has_sign = True
        if self.is_asking:
            self._signs[sign.name] = sign.locks

    def take_answer(self, answer: Answer) -> bool:
        """Note the end of an answer: with the last one, one that locks itself and idles is homed.

        False for the answer to another line: GRBL numbers none, but one about its lock has a sign of it.
        """
        is_about_lock = self._has_sign or (self.is_asking and answer.error != 0)
        self._has_sign = False
        if self.is_asking and is_about_lock:
            self._count_answer()
        return is_about_lock

    def _count_answer(self) -> None:
        self._open_answers -= 1
        if not self.is_asking:
            self.homed = len(self._signs) == LOCK_SIGNS and all(self._signs.values())
