"""Dialect of GRBL 1.1, grblHAL and FluidNC: status reports, moves and stops."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum, auto

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.facts import HEALTH, WELL
from arboleda.model.messages import MotionState, Report
from arboleda_drivers.connections.stream import Write

from .grbl_book import Book
from .grbl_lines import (
    ASK_LOCK,
    CRITICAL,
    HOLD,
    LOCKS,
    QUERY,
    RESET,
    Alarm,
    Answer,
    Banner,
    Demand,
    Line,
    LockSign,
    State,
    Status,
    parsed,
)
from .lines import LineReader
from .machine import ANSWER_S, HOMING_S, Machine

SILENT_S = 1.0  # a controller answers a query in milliseconds
RESET_AGAIN_S = 0.5  # a reset that comes while an alarm is being said is lost
RESET_ENDS_S = 2.0
BOOT_S = 3.0  # an Arduino boots when its line is opened
SETTLE_S = 0.5  # one that idles for so long away from its goal has ended there
MOVES = {State.RUN, State.JOG, State.HOME, State.HOLD}
RESETTABLE = {State.HOLD: (0,), State.DOOR: (0, 1)}  # there nothing moves any more, and the place is kept
IDLE_ENOUGH = (State.ALARM, State.CHECK, State.SLEEP, State.TOOL)  # nothing moves, and nothing is queued
UNHOMED, JUMPED = "not_homed", "place_jumped"
TROUBLES = {
    State.DOOR: "door",
    State.CHECK: "check_mode",
    State.SLEEP: "asleep",
    State.HOLD: "hold",
    State.TOOL: "tool_change",
    State.STARTING: "starting",
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
    was_reset: bool = False
    sent: bool = False
    answered: bool = False

    @property
    def is_under_way(self) -> bool:
        return self.sent and not self.answered


class GrblMachine(Machine):
    """State machine of a machine with GRBL."""

    _known = False  # it has told a status before, on this line or an earlier one
    _firmware = ""

    def _forget_link(self, now: float) -> None:
        super()._forget_link(now)
        self._opened_at = now
        self._book = Book(self._robot, self._settings)
        self._lines: LineReader[Line] = LineReader(parsed)
        self._status: Status | None = None
        self._patience_s = BOOT_S
        self._work: Move | Homing | None = None
        self._alarm: str | None = None  # the last one thrown, until the state is another one
        self._is_critical = False  # it hears nothing but a reset
        self._step: Step | None = None
        self._step_at = now
        self._resets, self._reset_at = 0, -math.inf  # those from here that have not ended yet
        self._is_alarmed = False  # an alarm was thrown after the last status

    @property
    def _at_work(self) -> bool:
        return self._work is not None or self._step is not None

    def _listen(self, now: float, data: bytes) -> None:
        for line in self._lines.feed(data):
            if self._open:
                self._hear(now, line)

    def _wait(self, now: float) -> None:
        work = self._work
        if isinstance(work, Homing) and now - work.began_at > HOMING_S:
            self._halt(now)
            self._tell(failed=work.id, failure="homing_has_no_end")
        # GRBL answers no query before a homing has ended.
        homes = isinstance(self._work, Homing) and self._work.is_under_way
        if now - self._last_data_at > self._patience_s and not homes:
            self._close(
                now, f"it has told no status for {self._patience_s:g} s; is it GRBL 1.1, at this baud?"
            )
        elif isinstance(work, Move) and min(work.taken_at, now) - work.sent_at > ANSWER_S:
            self._close(now, f"it has not answered a move for {ANSWER_S:g} s")
        else:
            self._stop_unheard(now)
            if now >= self._query_at:
                self._query_at = now + self._settings.poll_s
                self._out.append(Write(data=QUERY))

    def _stop_unheard(self, now: float) -> None:
        """Hold, then reset, what is silent on a new line: it homes, or waits for a reset after an alarm."""
        waits_s = now - self._step_at
        if self._step is Step.RESETTING:
            if waits_s > RESET_AGAIN_S:
                self._reset(now)  # what it asks for is the same however often it is said
        elif self._status is None and now - self._opened_at > SILENT_S:
            if self._step is None:
                self._halt(now)
            elif waits_s > SILENT_S:
                self._reset(now)

    # Commands.

    def _move(self, now: float, command: MoveJoints) -> None:
        assert self._status is not None
        if self._status.state is not State.IDLE:
            self._reject(command.id, self._trouble(self._status) or "not_idle")
            return
        if not self._book.homed:
            self._reject(command.id, UNHOMED if self._book.is_known else "busy")
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
        if homes or self._is_critical:
            self._last_data_at = now  # until then it may have been silent, and rightly
            self._reset(now)
        else:
            self._step, self._step_at = Step.HOLDING, now
            self._out.append(Write(data=HOLD))

    def _reset(self, now: float) -> None:
        self._step, self._step_at = Step.RESETTING, now
        self._resets, self._reset_at = self._resets + 1, now
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
            self._take_alarm(now, line)
        elif isinstance(line, Demand):
            self._lead_out(now)
        elif isinstance(line, LockSign):
            self._book.take_sign(line)
        elif isinstance(line, Banner):
            self._firmware = line.firmware
            self._begun(now)

    def _take_alarm(self, now: float, alarm: Alarm) -> None:
        self._last_data_at, self._news = now, True
        self._is_alarmed = True
        self._book.lose()
        if alarm.code != LOCKS.get(self._firmware):
            self._alarm = alarm.word
        if self._work is not None:
            self._fail(self._work.id, alarm.word)
        if alarm.code in CRITICAL:
            self._lead_out(now)

    def _lead_out(self, now: float) -> None:
        """Reset it, as it hears and says nothing else; it stands, and is locked or not homed after that."""
        self._is_critical, self._patience_s = True, BOOT_S
        if self._step is not Step.RESETTING:
            self._reset(now)

    def _begun(self, now: float) -> None:
        """Take the banner: the end of a reset, by an alarm or from here, or a boot."""
        self._last_data_at, self._is_critical = now, False
        self._book.begin()
        was_asked = self._resets > 0 and now - self._reset_at < RESET_ENDS_S
        self._resets = self._resets - 1 if was_asked else 0
        if self._step is Step.RESETTING:
            self._step = None
            self._confirm_stop()
        elif not was_asked and not self._is_alarmed:
            self._take_boot()

    def _take_boot(self) -> None:
        """Its place is lost, also where it does not lock itself; nobody waits for what it did before."""
        self._book.lose()
        self._work, self._step, self._alarm = None, None, None
        self._left_at_work, self._news = False, True
        if self._known:
            self._boot += 1
            self._receipts = {}

    def _answered(self, now: float, answer: Answer) -> None:
        work = self._work
        if self._book.is_asking:
            self._book.take_answer()
            self._is_heard, self._news = self._is_heard or self._book.is_known, True
        elif isinstance(work, Move) and work.taken_at == math.inf:
            if answer.error:
                self._work = None
                self._reject(work.id, answer.word)
            else:
                work.taken_at = now
                self._tell(accepted=work.id)
        elif isinstance(work, Homing) and work.is_under_way:
            work.answered, self._last_data_at = True, now
            if answer.error:
                self._fail(work.id, answer.word)

    def _look(self, now: float, status: Status) -> None:
        before, self._status = self._status, status
        was_homed = self._book.homed
        self._last_data_at, self._patience_s, self._known = now, SILENT_S, True
        self._is_alarmed = False
        if status.state is not State.ALARM:
            self._alarm = None
        self._keep_book(now, status)
        if self._left_at_work:  # nobody waits for that work any more
            self._left_at_work = False
            self._halt(now)
        if self._step is not None:
            self._go_on_stopping(now, status)
        elif isinstance(self._work, Homing):
            self._go_home(now, self._work, status)
        elif self._work is not None:
            self._go_on(now, self._work, status)
        self._ask_lock(now, status)
        changes = before is None or (before.state, before.part, before.door) != (
            status.state,
            status.part,
            status.door,
        )
        self._news = self._news or changes or self._book.homed != was_homed

    def _keep_book(self, now: float, status: Status) -> None:
        """Note where it is, and whether it is homed; one that is elsewhere all at once is stopped."""
        if isinstance(self._work, Homing):
            self._book.skip()
        elif self._book.look(now, status, at_work=self._at_work) and isinstance(self._work, Move):
            self._fail(self._work.id, JUMPED)
            self._halt(now)

    def _ask_lock(self, now: float, status: Status) -> None:
        """Ask what the book has to know of its lock; on a new line it is heard from once that is answered."""
        if not self._at_work and self._book.asks(now, status):
            for line in ASK_LOCK:
                self._write(line)
        self._is_heard = self._is_heard or not self._book.is_asking

    def _go_on_stopping(self, now: float, status: Status) -> None:
        if self._step is Step.RESETTING:
            return
        stands = status.part in RESETTABLE.get(status.state, ())
        late = now - self._step_at > SETTLE_S
        if stands or status.state in IDLE_ENOUGH or (late and status.state is State.IDLE):
            self._reset(now)
        elif late and status.state not in RESETTABLE:  # where it brakes already, once is enough
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
            self._book.trust()
            self._tell(done=homing.id)
        elif homing.sent or status.state is State.RUN:
            return
        elif self._alarm is not None and not homing.was_reset:
            homing.was_reset = True  # some alarms are over only with one
            self._reset(now)
        elif status.state in (State.IDLE, State.ALARM):
            homing.sent, homing.answered = True, False
            self._write("$H" if self._settings.homing else "$X")
        elif status.part in RESETTABLE.get(status.state, ()) or status.state in IDLE_ENOUGH:
            self._reset(now)

    def _fail(self, id: str, word: str) -> None:
        self._work = None
        self._tell(failed=id, failure=word)

    # What the plant hears.

    def _trouble(self, status: Status) -> str | None:
        """The word for what keeps the machine from moving; None if nothing does."""
        if self._alarm is not None or status.state is State.ALARM:
            return self._alarm or "locked"
        return TROUBLES.get(status.state)

    def _state(self, status: Status) -> MotionState:
        if isinstance(self._work, Homing):
            return MotionState.NOT_HOMED
        moves = self._work is not None or self._step is not None or status.state in MOVES
        if moves and not self._is_critical:
            return MotionState.MOVING
        if self._alarm is not None or self._is_critical:
            return MotionState.FAULT
        if status.state is State.ALARM or (status.state is State.IDLE and not self._book.homed):
            return MotionState.NOT_HOMED if self._book.is_known else MotionState.MOVING
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
            homed=self._book.homed and not isinstance(self._work, Homing) if self._book.is_known else None,
            q=self._settings.joints(status.position),
            facts=(
                (HEALTH, self._trouble(status) or (JUMPED if self._book.has_jumped else WELL)),
                ("door", "open" if status.door or status.state is State.DOOR else "closed"),
                ("mode", status.state.value.lower()),
            ),
        )
