"""Dialect of Moonraker, the server in front of Klipper: moves in pieces, by what Klipper says of its motion.

Klipper ends a queued move early only by its shutdown, which loses the place. But it always plans to a rest at
the end of the last line that it has: so a move is sent in pieces, as it goes on, and a stop sends no more.
"""

from __future__ import annotations

from arboleda.drivers import HEALTH, WELL, Home, MotionState, MoveJoints, Report
from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.stream import Received

from .controller import ANSWER_S, HOMING_S, GcodeController
from .lines import LineReader
from .moonraker_lines import (
    BEGINS,
    DISCONNECTED,
    OBJECTS,
    READY,
    UNHOMED,
    Answer,
    Line,
    Motion,
    Notice,
    Status,
    parsed,
)
from .moonraker_work import ABSOLUTE, Ask, Halt, Homing, MoonrakerStop, Move, Requests

LONGEST = 65536  # bytes of a line
SILENT_S = 3.0  # Klipper answers a question within 0.25 s, or as long again where its computer is busy
UNAUTHORIZED, UNAVAILABLE = 401, 503
NO_MOTION = "its status has no position of the machine; is it Klipper of 2021 or later?"


class Moonraker(GcodeController):
    """Controller with Klipper behind Moonraker."""

    _told = ""  # Klipper's state when it told one last, on this line or an earlier one

    def forget(self, now: float) -> None:
        super().forget(now)
        self.requests = Requests(self.out)
        self.stops: MoonrakerStop = MoonrakerStop(self.requests, self.receipts, now)
        self._lines: LineReader[Line] = LineReader(parsed, longest=LONGEST)
        self._asked_at = now
        self._klippy = ""
        self._motion: Motion | None = None
        self._work: Move | Homing | None = None

    def greet(self, now: float) -> None:
        self.requests.ask(
            Ask.NAME,
            "server.connection.identify",
            client_name="Arboleda",
            version="1",
            type="other",
            url="https://moonraker.readthedocs.io",
        )

    @property
    def is_busy(self) -> bool:
        under_way = self._work is not None or self.stops.how is not None
        return under_way or self.requests.waits_for(Ask.PIECE)

    def pass_time(self, now: float) -> None:
        work, asks = self._work, self.requests.waits_for(Ask.NAME, Ask.STATUS)
        if asks and now - self._asked_at > SILENT_S:
            raise LinkBroken(f"it has not answered for {SILENT_S:g} s; is it Moonraker, with Klipper?")
        if isinstance(work, Move) and not work.has_turn and now - work.sent_at > ANSWER_S:
            self._work = None
            self.receipts.reject(work.id, "busy_elsewhere")
        elif isinstance(work, Homing) and now - work.began_at > HOMING_S:
            self._give_up(now, "homing_has_no_end")
        else:
            self.stops.go_on(now, is_ready=self._klippy == READY)
        if now >= self.query_at:
            self.query_at = now + self.settings.poll_s
            if not asks:
                self._asked_at = now
                self.requests.ask(Ask.STATUS, "printer.objects.query", objects=OBJECTS)

    # Commands.

    def move(self, now: float, command: MoveJoints) -> None:
        motion, settings = self._motion, self.settings
        if motion is None or self._klippy != READY:
            self.receipts.reject(command.id, self._klippy)
        elif not motion.has_homed(settings.axes):
            self.receipts.reject(command.id, UNHOMED)
        elif not motion.stands:
            self.receipts.reject(command.id, "not_idle")
        elif not motion.allows(goal := settings.place(command.q, motion.ordered)):
            self.receipts.reject(command.id, "beyond_travel")
        else:
            self._work = Move(
                id=command.id,
                sent_at=now,
                start=motion.ordered,
                goal=goal,
                base=motion.base,
                mm_s=settings.feed(self.robot, settings.joints(motion.ordered), command.q) / 60,
            )
            self.requests.script(Ask.TURN, ABSOLUTE)
            self._work.turn = self.requests.number

    def home(self, now: float, command: Home) -> None:
        if self._klippy != READY or self._motion is None:
            self.receipts.reject(command.id, self._klippy)
        elif not self._motion.stands:
            self.receipts.reject(command.id, "not_idle")
        else:
            self._work = Homing(id=command.id, began_at=now)
            self.receipts.tell(accepted=command.id)
            self.requests.script(Ask.HOME, "G28")

    def halt(self, now: float) -> None:
        """Send no more. Homing goes to its end by itself: that is shut down."""
        homes = isinstance(self._work, Homing) and not self._work.is_answered
        self._work, self.receipts.news = None, True
        if self._klippy != READY:
            if self.stops.how is None:
                self.stops.end()
        elif homes:
            self.stops.shut_down(now)
        else:
            self.stops.send_no_more(now)

    # What it says.

    def hear(self, now: float, event: Received) -> None:
        for line in self._lines.feed(event.data):
            if isinstance(line, Notice):
                self._go_down(now, line.state)
            elif (ask := self.requests.take(line.number)) is not None:
                self._take(now, ask, line)

    def _take(self, now: float, ask: Ask, answer: Answer) -> None:
        work, refusal = self._work, answer.refusal
        if answer.code == UNAUTHORIZED or (ask is Ask.NAME and refusal is not None):
            raise LinkBroken(f"it does not let the driver in: {(refusal or '')[:80]}")
        if ask is Ask.STATUS:
            self._take_status(now, answer)
        elif ask in (Ask.PIECE, Ask.END):
            self.requests.old = self.requests.number
            if ask is Ask.PIECE and isinstance(work, Move):
                self._take_piece(now, work, answer)
        elif ask is Ask.TURN and isinstance(work, Move) and answer.number == work.turn:
            if refusal is not None:
                self._work = None
                self.receipts.reject(work.id, answer.word)
            elif self._motion is not None:
                work.has_turn = True
                work.send_pieces(self.requests, self._motion, self.settings.axes)
        elif ask is Ask.HOME and isinstance(work, Homing):
            self.requests.old, work.is_answered = self.requests.number, True
            if refusal is not None:
                self._give_up(now, answer.word)

    def _take_piece(self, now: float, move: Move, answer: Answer) -> None:
        if answer.refusal is None:
            if not move.is_taken:
                move.is_taken = True
                self.receipts.tell(accepted=move.id)
        elif move.is_taken:
            self._give_up(now, answer.word)
        else:
            self.receipts.reject(move.id, answer.word)
            self._work = None

    def _take_status(self, now: float, answer: Answer) -> None:
        if answer.refusal is not None:
            if answer.code == UNAVAILABLE:
                self._go_down(now, DISCONNECTED)
            else:
                raise LinkBroken(f"it does not tell its status: {answer.refusal[:80]}")
        elif answer.status is None or (answer.status.state == READY and answer.status.motion is None):
            raise LinkBroken(NO_MOTION)
        elif answer.status.state != READY:
            self._go_down(now, answer.status.state)
        else:
            self._look(now, answer.status, is_new=answer.number > self.requests.old)

    def _go_down(self, now: float, state: str) -> None:
        """Take it that Klipper is not ready: nothing that it was told goes on, and its place is lost."""
        self.is_heard, self.heard_at = True, now
        if state == self._klippy:
            return
        was_ready, self._klippy, self.receipts.news = self._klippy in (READY, ""), state, True
        self._motion, self.has_leftover = None, False
        self.requests.drop()
        if state in BEGINS and self._told not in ("", *BEGINS):
            self._begin_anew()
        elif self._work is not None:
            self.receipts.tell(failed=self._work.id, failure=state)
        self._work, self._told = None, state
        if was_ready:
            self.stops.begin(now, Halt.SHUTDOWN)

    def _begin_anew(self) -> None:
        self.boot += 1
        self.receipts.forget()
        self.stops.id = ""

    def _look(self, now: float, status: Status, *, is_new: bool) -> None:
        motion, before, work = status.motion, self._motion, self._work
        assert motion is not None
        if self._klippy not in (READY, ""):
            self.stops.how = None  # of what was before
        if self._told not in (READY, "", *BEGINS):  # and only a restart leads out of that
            self._begin_anew()
        self.receipts.news = self.receipts.news or before is None or before.stands != motion.stands
        self.is_heard, self.heard_at = True, now
        self._klippy = self._told = READY
        self._motion = motion
        if self.has_leftover:
            self.has_leftover = False
            self.halt(now)
        elif self.stops.how is Halt.NO_MORE:
            if is_new and motion.stands and not self.requests.waits_for(Ask.PIECE, Ask.END):
                self.stops.end()
        elif isinstance(work, Homing):
            if work.is_answered and is_new and motion.stands:
                self._work = None
                homed = motion.has_homed(self.settings.axes)
                self.receipts.tell(**{"done": work.id} if homed else {"failed": work.id, "failure": UNHOMED})
        elif work is not None and work.has_turn:
            self._go_on(now, work, motion, is_new=is_new)

    def _go_on(self, now: float, move: Move, motion: Motion, *, is_new: bool) -> None:
        if not motion.has_homed(self.settings.axes):
            self._give_up(now, UNHOMED)
        elif not (move.has_sent(motion.ordered) and move.leads_by(motion.place)):
            self._give_up(now, "moved_elsewhere")  # by another client, and the next piece would lead back
        else:
            move.send_pieces(self.requests, motion, self.settings.axes)
            if is_new and motion.stands and not self.requests.waits_for(Ask.PIECE):
                self._work = None  # at its goal, or it has ended here
                self.receipts.tell(done=move.id)

    def _give_up(self, now: float, word: str) -> None:
        """Tell that it failed. What was sent of a move ends by itself, and others may go on with theirs."""
        assert self._work is not None
        self.receipts.tell(failed=self._work.id, failure=word)
        if isinstance(self._work, Homing):
            self.halt(now)
        self._work = None

    # What the plant hears.

    @property
    def _state(self) -> MotionState:
        if self.stops.how is not None or isinstance(self._work, Move) or self.requests.waits_for(Ask.PIECE):
            return MotionState.MOVING
        if self._motion is None:
            return MotionState.FAULT
        if isinstance(self._work, Homing):
            return MotionState.NOT_HOMED
        if not self._motion.stands:
            return MotionState.MOVING
        if not self._motion.has_homed(self.settings.axes):
            return MotionState.NOT_HOMED
        return MotionState.STOP_LATCHED if self.is_latched else MotionState.STOPPED

    def report(self, now: float) -> Report:
        motion, is_ready = self._motion, self._klippy == READY
        is_homed = motion is not None and motion.has_homed(self.settings.axes)
        busy = self.is_busy or (motion is not None and not motion.stands)
        return Report(
            at=now,
            robot=self.robot.name,
            boot_id=self.boot,
            state=self._state,
            homed=is_homed and not isinstance(self._work, Homing),
            q=None if motion is None else self.settings.joints(motion.place),
            facts=(
                (HEALTH, WELL if is_ready else self._klippy),
                ("mode", ("busy" if busy else "idle") if is_ready else self._klippy),
            ),
        )
