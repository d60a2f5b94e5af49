"""Dialect of GRBL 1.1: its status reports, its moves and its stops."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum, auto

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.facts import HEALTH, WELL
from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState

from ..stream import Write
from .grbl_lines import HOLD, QUERY, RESET, Alarm, Answer, Banner, Line, State, Status, parsed
from .lines import LineReader
from .machine import ANSWER_S, HOMING_S, Machine

SILENT_S = 1.0  # a controller answers a query in milliseconds
BOOT_S = 3.0  # an Arduino boots when its line is opened
SETTLE_S = 0.5  # one that idles for so long away from its goal has ended there
MOVES = {State.RUN, State.JOG, State.HOME, State.HOLD}
RESETTABLE = {State.HOLD: (0,), State.DOOR: (0, 1)}  # there nothing moves any more, and the place is kept
TROUBLES = {
    State.DOOR: "door",
    State.CHECK: "check_mode",
    State.SLEEP: "asleep",
    State.HOLD: "hold",
}


class Step(Enum):
    """Step of a stop, or of the way to readiness."""

    HOLDING = auto()  # until the machine has come to rest
    RESETTING = auto()  # until the controller has begun anew


@dataclass(kw_only=True)
class Move:
    """Line of a move: taken when it is answered, over when the controller idles after that."""

    id: str
    q: tuple[float, ...]
    sent_at: float
    taken_at: float = math.inf
    idle_since: float | None = None


@dataclass(kw_only=True)
class Homing:
    """Homing cycle: a reset where one is needed, the cycle, and its answer."""

    id: str
    began_at: float
    sent: bool = False
    answered: bool = False


class GrblMachine(Machine):
    """State machine of a machine with GRBL."""

    _known = False  # it has told a status before, on this line or an earlier one

    def _forget_link(self, now: float) -> None:
        super()._forget_link(now)
        self._lines: LineReader[Line] = LineReader(parsed)
        self._status: Status | None = None
        self._patience_s = BOOT_S
        self._work: Move | Homing | None = None
        self._alarm: str | None = None  # the last one thrown, until the state is another one
        self._step: Step | None = None
        self._step_at = now
        self._resets = False  # a reset from here has not ended yet

    @property
    def _at_work(self) -> bool:
        return self._work is not None or self._step is not None

    def _listen(self, now: float, data: bytes) -> None:
        for line in self._lines.feed(data):
            if self._open:
                self._hear(now, line)

    def _wait(self, now: float) -> None:
        if now - self._last_data_at > self._patience_s:
            self._close(
                now, f"it has told no status for {self._patience_s:g} s; is it GRBL 1.1, at this baud?"
            )
        elif isinstance(self._work, Move) and min(self._work.taken_at, now) - self._work.sent_at > ANSWER_S:
            self._close(now, f"it has not answered a move for {ANSWER_S:g} s")
        elif now >= self._query_at:
            self._query_at = now + self._settings.poll_s
            self._out.append(Write(data=QUERY))

    # Commands.

    def _move(self, now: float, command: MoveJoints) -> None:
        assert self._status is not None
        if self._status.state is not State.IDLE:
            self._reject(command.id, self._trouble(self._status) or "not_idle")
            return
        feed = self._feed(self._settings.joints(self._status.position), command.q)
        self._work = Move(id=command.id, q=command.q, sent_at=now)
        self._write(f"G90G21G53G1{self._settings.words(command.q)}F{feed:.1f}")

    def _home(self, now: float, command: Home) -> None:
        self._work = Homing(id=command.id, began_at=now)  # goes on once it was reported as not homed
        self._tell(accepted=command.id)

    def _halt(self, now: float) -> None:
        """Hold the feed; once all stands, a reset empties the queue. Homing hears nothing but a reset."""
        homes = isinstance(self._work, Homing) or (
            self._status is not None and self._status.state is State.HOME
        )
        self._work, self._news = None, True
        if homes:
            self._reset(now)
        else:
            self._step, self._step_at = Step.HOLDING, now
            self._out.append(Write(data=HOLD))

    def _reset(self, now: float) -> None:
        self._step, self._step_at = Step.RESETTING, now
        self._resets = True
        self._out.append(Write(data=RESET))

    # What it says.

    def _hear(self, now: float, line: Line) -> None:
        if isinstance(line, Status):
            if not line.position or len(line.position) < len(self._settings.axes):
                self._close(now, "its status has no position of the machine; set $10=1")
                return
            self._look(now, line)
        elif isinstance(line, Answer):
            self._answered(now, line)
        elif isinstance(line, Alarm):
            self._alarm, self._news = line.word, True
            if self._work is not None:
                self._fail(self._work.id, line.word)
        elif isinstance(line, Banner):
            self._begun(now)

    def _begun(self, now: float) -> None:
        """Take the banner: the end of a reset from here, or a boot."""
        self._last_data_at = now
        resets, self._resets = self._resets, False
        if self._step is Step.RESETTING:
            self._step = None
            self._confirm_stop()
        elif resets:
            return  # the end of a reset, after which another stop was given
        elif self._known:
            self._boot += 1
            self._receipts, self._work, self._step, self._alarm = {}, None, None, None
            self._left_at_work, self._news = False, True

    def _answered(self, now: float, answer: Answer) -> None:
        work = self._work
        if isinstance(work, Move) and work.taken_at == math.inf:
            if answer.error:
                self._work = None
                self._reject(work.id, answer.word)
            else:
                work.taken_at = now
                self._tell(accepted=work.id)
        elif isinstance(work, Homing) and work.sent and not work.answered:
            work.answered = True
            if answer.error:
                self._fail(work.id, answer.word)

    def _look(self, now: float, status: Status) -> None:
        before, self._status = self._status, status
        self._is_heard, self._last_data_at, self._patience_s, self._known = True, now, SILENT_S, True
        if status.state is not State.ALARM:
            self._alarm = None
        if self._left_at_work:  # nobody waits for that work any more
            self._left_at_work = False
            self._halt(now)
        if self._step is not None:
            self._go_on_stopping(now, status)
        elif isinstance(self._work, Homing):
            self._go_home(now, self._work, status)
        elif self._work is not None:
            self._go_on(now, self._work, status)
        changes = before is None or (before.state, before.part, before.door) != (
            status.state,
            status.part,
            status.door,
        )
        self._news = self._news or changes

    def _go_on_stopping(self, now: float, status: Status) -> None:
        if self._step is Step.RESETTING:
            if now - self._step_at > SILENT_S:
                self._reset(now)  # what it asks for is the same however often it is said
            return
        stands = status.part in RESETTABLE.get(status.state, ())
        late = now - self._step_at > SETTLE_S
        if (
            stands
            or status.state in (State.ALARM, State.CHECK, State.SLEEP)
            or (late and status.state is State.IDLE)
        ):
            self._reset(now)
        elif late:
            self._step_at = now
            self._out.append(Write(data=HOLD))

    def _go_on(self, now: float, move: Move, status: Status) -> None:
        trouble = self._trouble(status)
        if trouble is not None:
            self._fail(move.id, trouble)
            if status.state in RESETTABLE:
                self._halt(now)  # or it would go on once the door is closed, or somebody says so
            return
        if now <= move.taken_at or status.state is not State.IDLE:
            move.idle_since = None
            return
        move.idle_since = now if move.idle_since is None else move.idle_since
        there = self._robot.motion.stands_at(self._settings.joints(status.position), move.q)
        # Idle away from the goal may be the moment before the begin: only one that stays so has ended.
        if there or now - move.idle_since > SETTLE_S:
            self._work = None
            self._tell(done=move.id)

    def _go_home(self, now: float, homing: Homing, status: Status) -> None:
        ready = status.state is State.IDLE and (homing.answered or not self._settings.homing)
        if ready:
            self._work = None
            self._tell(done=homing.id)
        elif now - homing.began_at > HOMING_S:
            self._fail(homing.id, "homing_has_no_end")
            self._halt(now)
        elif homing.sent or status.state is State.RUN:
            return
        elif status.state in (State.IDLE, State.ALARM):
            homing.sent, homing.answered = True, False
            self._write("$H" if self._settings.homing else "$X")
        elif status.part in RESETTABLE.get(status.state, ()) or status.state in (State.CHECK, State.SLEEP):
            self._reset(now)

    def _fail(self, id: str, word: str) -> None:
        self._work = None
        self._tell(failed=id, failure=word)

    # What the plant hears.

    def _trouble(self, status: Status) -> str | None:
        """The word for what keeps the machine from moving; None if nothing does."""
        if status.state is State.ALARM:
            return self._alarm or "locked"
        return TROUBLES.get(status.state)

    def _state(self, status: Status) -> MotionState:
        if isinstance(self._work, Homing):
            return MotionState.NOT_HOMED
        if self._work is not None or self._step is not None or status.state in MOVES:
            return MotionState.MOVING
        if status.state is State.ALARM and self._alarm is None:
            return MotionState.NOT_HOMED
        if self._latched:
            return MotionState.STOP_LATCHED
        return MotionState.STOPPED if status.state is State.IDLE else MotionState.FAULT

    def _report(self, now: float) -> Report:
        status = self._status
        assert status is not None
        return Report(
            at=now,
            robot=self._robot.name,
            boot_id=self._boot,
            state=self._state(status),
            homed=status.state not in (State.ALARM, State.HOME) and not isinstance(self._work, Homing),
            q=self._settings.joints(status.position),
            facts=(
                (HEALTH, self._trouble(status) or WELL),
                ("door", "open" if status.door or status.state is State.DOOR else "closed"),
                ("mode", status.state.value.lower()),
            ),
        )
