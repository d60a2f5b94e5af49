"""Work of a machine with GRBL: a move, and homing; each finds its own end in the statuses."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from arboleda_drivers.connections.receipts import Look

from .grbl_lines import LOCKS, Alarm, Answer, State, Status
from .grbl_stop import IDLE_ENOUGH, RESETTABLE, SETTLE_S

NOT_AT_ZERO = "not_at_zero"
TROUBLES = {
    State.DOOR: "door",
    State.CHECK: "check_mode",
    State.SLEEP: "asleep",
    State.HOLD: "hold",
    State.TOOL: "tool_change",
    State.STARTING: "starting",
}


@dataclass(kw_only=True)
class LastAlarm:
    """Alarm that was thrown last, by its `word`, until the state is another one; None for none."""

    word: str | None = None
    is_fresh: bool = False  # it was thrown after the last status

    def take(self, alarm: Alarm, firmware: str) -> None:
        self.is_fresh = True
        if alarm.code != LOCKS.get(firmware):
            self.word = alarm.word

    def see(self, status: Status) -> None:
        self.is_fresh = False
        if status.state is not State.ALARM:
            self.word = None

    def trouble(self, status: Status) -> str | None:
        """The word for what keeps the machine from moving; None if nothing does."""
        if self.word is not None or status.state is State.ALARM:
            return self.word or "locked"
        return TROUBLES.get(status.state)


@dataclass(frozen=True, kw_only=True)
class GrblLook(Look):
    """Progress of a work; `halts`: the machine is to be stopped, or `resets`: reset."""

    halts: bool = False
    resets: bool = False


NOTHING = GrblLook()


@dataclass(kw_only=True)
class Move:
    """Line of a move: taken when it is answered, over when the controller idles after that."""

    id: str
    is_there: Callable[[Status], bool]
    sent_at: float
    taken_at: float = math.inf
    idle_since: float | None = None

    def take(self, now: float, answer: Answer) -> GrblLook:
        if self.taken_at < math.inf:
            return NOTHING
        if answer.error:
            return GrblLook(refused=answer.word)
        self.taken_at = now
        return GrblLook(accepted=True)

    def look(self, now: float, status: Status, alarm: LastAlarm) -> GrblLook:
        trouble = alarm.trouble(status)
        if trouble is not None:
            # A held one would go on once the door is closed, or somebody says so.
            return GrblLook(failed=trouble, halts=status.state in RESETTABLE)
        if now <= self.taken_at or status.state is not State.IDLE:
            self.idle_since = None
            return NOTHING
        self.idle_since = now if self.idle_since is None else self.idle_since
        # Idle away from the goal may be the moment before the begin: only one that stays so has ended.
        return GrblLook(done=self.is_there(status) or now - self.idle_since > SETTLE_S)


@dataclass(kw_only=True)
class Homing:
    """Homing: a reset where one is needed, and the cycle. One that `has_switches` not is unlocked instead: a
    person says that it stands at its zero, which has to be where it counts 0.
    """

    id: str
    began_at: float
    has_switches: bool
    is_at_zero: Callable[[Status], bool]
    was_reset: bool = False
    sent: bool = False
    answered: bool = False

    @property
    def is_under_way(self) -> bool:
        return self.sent and not self.answered

    def take(self, now: float, answer: Answer) -> GrblLook:
        if not self.is_under_way:
            return NOTHING
        self.answered = True
        return GrblLook(failed=answer.word) if answer.error else NOTHING

    def look(self, now: float, status: Status, alarm: LastAlarm) -> GrblLook:
        if status.state is State.IDLE and not self.has_switches:
            return GrblLook(done=True) if self.is_at_zero(status) else GrblLook(failed=NOT_AT_ZERO)
        if status.state is State.IDLE and self.answered:
            return GrblLook(done=True)
        if self.sent or status.state is State.RUN:
            return NOTHING
        if alarm.word is not None and not self.was_reset:
            self.was_reset = True  # some alarms are over only with one
            return GrblLook(resets=True)
        if status.state in (State.IDLE, State.ALARM):
            self.sent, self.answered = True, False
            return GrblLook(lines=("$H" if self.has_switches else "$X",))
        stands = status.part in RESETTABLE.get(status.state, ()) or status.state in IDLE_ENOUGH
        return GrblLook(resets=stands)


Work = Move | Homing
