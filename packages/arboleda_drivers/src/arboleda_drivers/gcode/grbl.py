"""Dialect of GRBL 1.1, grblHAL and FluidNC: status reports, moves and stops."""

from __future__ import annotations

from arboleda.drivers import HEALTH, WELL, Home, MotionState, MoveJoints, Report
from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.stream import Received, Write

from .controller import ANSWER_S, HOMING_S, GcodeController
from .grbl_book import Book
from .grbl_lines import (
    ASK_LOCK,
    CRITICAL,
    QUERY,
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
from .grbl_stop import SILENT_S, GrblStop, Step
from .grbl_work import GrblLook, Homing, LastAlarm, Move, Work
from .lines import LineReader, written
from .settings import LETTERS

BOOT_S = 3.0  # an Arduino boots when its line is opened
MOVES = {State.RUN, State.JOG, State.HOME, State.HOLD}
ZERO = (0.0,) * len(LETTERS)
UNHOMED, JUMPED = "not_homed", "place_jumped"


class Grbl(GcodeController):
    """Controller with GRBL."""

    _has_told = False  # a status before, on this line or an earlier one
    _firmware = ""

    def forget(self, now: float) -> None:
        super().forget(now)
        self.stops: GrblStop = GrblStop(self.out, self.receipts, now)
        self.book = Book(self.robot, self.settings)
        self.alarm = LastAlarm()
        self._opened_at = now
        self._lines: LineReader[Line] = LineReader(parsed)
        self._status: Status | None = None
        self._patience_s = BOOT_S
        self._work: Work | None = None

    @property
    def is_busy(self) -> bool:
        return self._work is not None or self.stops.how is not None

    def hear(self, now: float, event: Received) -> None:
        for line in self._lines.feed(event.data):
            self._take(now, line)

    def pass_time(self, now: float) -> None:
        work = self._work
        if isinstance(work, Homing) and now - work.began_at > HOMING_S:
            self.halt(now)
            self.receipts.tell(failed=work.id, failure="homing_has_no_end")
        # GRBL answers no query before a homing has ended.
        homes = isinstance(self._work, Homing) and self._work.is_under_way
        if now - self.heard_at > self._patience_s and not homes:
            raise LinkBroken(
                f"it has told no status for {self._patience_s:g} s; is it GRBL 1.1, at this baud?"
            )
        if isinstance(work, Move) and min(work.taken_at, now) - work.sent_at > ANSWER_S:
            raise LinkBroken(f"it has not answered a move for {ANSWER_S:g} s")
        # What is silent on a new line homes, or waits for a reset after an alarm.
        is_silent = self._status is None and now - self._opened_at > SILENT_S
        if is_silent and self.stops.how is None:
            self.halt(now)
        self.stops.insist(now, is_silent=is_silent)
        if now >= self.query_at:
            self.query_at = now + self.settings.poll_s
            self.out.append(Write(data=QUERY))

    # Commands.

    def move(self, now: float, command: MoveJoints) -> None:
        assert self._status is not None
        if self._status.state is not State.IDLE:
            self.receipts.reject(command.id, self.alarm.trouble(self._status) or "not_idle")
            return
        if not self.book.homed:
            self.receipts.reject(command.id, UNHOMED if self.book.is_known else "busy")
            return
        settings, stands_at = self.settings, self.robot.motion.stands_at
        feed = settings.feed(self.robot, settings.joints(self._status.position), command.q)
        self._work = Move(
            id=command.id,
            is_there=lambda status: stands_at(settings.joints(status.position), command.q),
            sent_at=now,
        )
        self.out.append(written(f"G90G21G53G1{settings.words(command.q)}F{feed:.1f}"))

    def home(self, now: float, command: Home) -> None:
        # It goes on once it was reported as not homed.
        settings, stands_at = self.settings, self.robot.motion.stands_at
        self._work = Homing(
            id=command.id,
            began_at=now,
            has_switches=settings.homing,
            is_at_zero=lambda status: stands_at(settings.joints(status.position), settings.joints(ZERO)),
        )
        self.receipts.tell(accepted=command.id)

    def halt(self, now: float) -> None:
        """Hold the feed; once all stands, a reset empties the queue. Homing hears nothing but a reset."""
        homes = isinstance(self._work, Homing) or (
            self._status is not None and self._status.state is State.HOME
        )
        self._work, self.receipts.news = None, True
        if homes or self.stops.is_critical:
            self.heard_at = now  # until then it may have been silent, and rightly
            self.stops.reset(now)
        else:
            self.stops.hold(now)

    # What it says.

    def _take(self, now: float, line: Line) -> None:
        if isinstance(line, Status):
            if not line.position or len(line.position) < len(self.settings.axes):
                raise LinkBroken("its status has no position of the machine; set $10=1")
            self._look(now, line)
        elif isinstance(line, Answer):
            self._take_answer(now, line)
        elif isinstance(line, Alarm):
            self._take_alarm(now, line)
        elif isinstance(line, Demand):
            self._patience_s = BOOT_S
            self.stops.lead_out(now)
        elif isinstance(line, LockSign):
            self.book.take_sign(line)
        elif isinstance(line, Banner):
            self._firmware = line.firmware
            self._take_begin(now)

    def _take_alarm(self, now: float, alarm: Alarm) -> None:
        self.heard_at, self.receipts.news = now, True
        self.book.lose()
        self.alarm.take(alarm, self._firmware)
        self._go_on(now, GrblLook(failed=alarm.word))
        if alarm.code in CRITICAL:
            self._patience_s = BOOT_S
            self.stops.lead_out(now)

    def _take_begin(self, now: float) -> None:
        """Take the banner: the end of a reset, by an alarm or from here, or a boot."""
        self.heard_at = now
        self.book.begin()
        was_asked = self.stops.was_asked(now)
        if self.stops.how is Step.RESETTING:
            self.stops.end()
        elif not was_asked and not self.alarm.is_fresh:
            self._take_boot()

    def _take_boot(self) -> None:
        """Its place is lost, also where it does not lock itself; nobody waits for what it did before."""
        self.book.lose()
        self._work, self.stops.how, self.alarm.word = None, None, None
        self.has_leftover, self.receipts.news = False, True
        if self._has_told:
            self.boot += 1
            self.receipts.forget()

    def _take_answer(self, now: float, answer: Answer) -> None:
        if self.book.take_answer(answer):
            self.is_heard, self.receipts.news = self.is_heard or self.book.is_known, True
        elif self._work is not None:
            if isinstance(self._work, Homing) and self._work.is_under_way:
                self.heard_at = now
            self._go_on(now, self._work.take(now, answer))

    def _look(self, now: float, status: Status) -> None:
        before, self._status = self._status, status
        was_homed = self.book.homed
        self.heard_at, self._patience_s, self._has_told = now, SILENT_S, True
        self.alarm.see(status)
        self._keep_book(now, status)
        if self.has_leftover:
            self.has_leftover = False
            self.halt(now)
        if self.stops.how is not None:
            self.stops.go_on(now, status)
        elif self._work is not None:
            self._go_on(now, self._work.look(now, status, self.alarm))
        if not self.is_busy and self.book.asks(now, status):
            self.out.extend(map(written, ASK_LOCK))
        self.is_heard = self.is_heard or not self.book.is_asking  # on a new line once that is answered
        shows = (status.state, status.part, status.door, self.book.homed)
        changes = before is None or (before.state, before.part, before.door, was_homed) != shows
        self.receipts.news = self.receipts.news or changes

    def _keep_book(self, now: float, status: Status) -> None:
        """Note where it is, and whether it is homed; one that is elsewhere all at once is stopped."""
        if isinstance(self._work, Homing):
            self.book.skip()
        elif self.book.look(now, status, at_work=self.is_busy) and isinstance(self._work, Move):
            self._go_on(now, GrblLook(failed=JUMPED, halts=True))

    def _go_on(self, now: float, look: GrblLook) -> None:
        """Go on with the work, or end it; without one nothing is done."""
        work = self._work
        if work is None:
            return
        self.receipts.take(work.id, look)
        if look.is_end:
            self._work = None
        if look.done and isinstance(work, Homing):
            self.book.trust()
        if look.halts:
            self.halt(now)
        elif look.resets:
            self.stops.reset(now)
        self.out.extend(map(written, look.lines))

    # What the plant hears.

    def _state(self, status: Status) -> MotionState:
        if isinstance(self._work, Homing):
            return MotionState.NOT_HOMED
        is_critical = self.stops.is_critical
        if (self.is_busy or status.state in MOVES) and not is_critical:
            return MotionState.MOVING
        if self.alarm.word is not None or is_critical:
            return MotionState.FAULT
        if status.state is State.ALARM or (status.state is State.IDLE and not self.book.homed):
            return MotionState.NOT_HOMED if self.book.is_known else MotionState.MOVING
        if self.is_latched:
            return MotionState.STOP_LATCHED
        return MotionState.STOPPED if status.state is State.IDLE else MotionState.FAULT

    def report(self, now: float) -> Report:
        status, book = self._status, self.book
        assert status is not None
        return Report(
            at=now,
            robot=self.robot.name,
            boot_id=self.boot,
            state=self._state(status),
            homed=book.homed and not isinstance(self._work, Homing) if book.is_known else None,
            q=self.settings.joints(status.position),
            facts=(
                (HEALTH, self.alarm.trouble(status) or (JUMPED if book.has_jumped else WELL)),
                ("door", "open" if status.door or status.state is State.DOOR else "closed"),
                ("mode", status.state.value.lower()),
            ),
        )
