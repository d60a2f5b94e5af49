"""Dialect of Marlin: one line after another, each with its answer, and stops that pass them.

`M400` waits until all moves have ended, and only then does `M114` tell where the machine is: before, it tells
where the last move will end. So nothing is known of the place under way.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from arboleda.drivers import HEALTH, WELL, Home, MotionState, MoveJoints, Report
from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.stream import Received

from . import marlin_lines
from .controller import ANSWER_S, HOMING_S, GcodeController
from .lines import LineReader, written
from .marlin_lines import (
    HALTED,
    STOPPED,
    UNHOMED,
    Busy,
    Capability,
    Line,
    Ok,
    Place,
    Refusal,
    Resend,
    Start,
    Trouble,
    parsed,
)
from .marlin_queue import ASK_NAME, Firmware, Halt, LineQueue, MarlinStop

SILENT_S = 3.0  # a busy controller says so once a second
BOOT_S = 10.0  # a board boots when its line is opened, some with a picture on their screen
SHUTDOWN_S = 2.0  # it moves on for 0.6 s after it says that it is halted, longer the faster it steps
SET_NUMBER, ASK_PLACE, FINISH, HOME_ALL, MOTORS_ON = "M110 N0", "M114", "M400", "G28", "M17"
ZERO_HERE = "G92"  # from here on it counts so
SETTINGS = ("M113 S1", "M84 S0")  # a sign of life each second; motors that never go off by themselves


@dataclass(kw_only=True)
class Move:
    """Move: taken when its line is answered, over when the place after that is known."""

    id: str
    sent_at: float
    is_answered: bool = False


@dataclass(kw_only=True)
class Homing:
    """Homing cycle, and its answer."""

    id: str
    began_at: float
    is_answered: bool = False


class Marlin(GcodeController):
    """Controller with Marlin."""

    def forget(self, now: float) -> None:
        super().forget(now)
        self._lines: LineReader[Line] = LineReader(parsed)
        self._begin(now)

    def _begin(self, now: float) -> None:
        """Know nothing of the controller: after a boot, or where nobody knows what happened meanwhile."""
        self.heard_at = now
        self.queue = LineQueue(self.out)
        self.stops: MarlinStop = MarlinStop(self.queue, self.receipts, now)
        self.firmware = Firmware(self.queue)
        self._is_homed = False
        self._moves_on = False  # it is at lines that nobody sent on this connection
        self._position: tuple[float, ...] | None = None
        self._place: Place | None = None  # of the answer that is under way
        self._refusal = self._trouble = ""
        self._work: Move | Homing | None = None

    def greet(self, now: float) -> None:
        # What is left of a line that was torn ends here, and takes no stop with it.
        self.out.append(written(""))
        if self.has_leftover:
            self.has_leftover = False
            self.stops.say(now, Halt.QUICK)
        self.queue.ask(SET_NUMBER)
        # Without a number: once Marlin comes to do M110 it counts anew, and refuses what follows a line that
        # it has read meanwhile.
        self.queue.ask_at_once(ASK_NAME)

    @property
    def is_busy(self) -> bool:
        return self._work is not None or self.stops.how is not None or self._moves_on

    def pass_time(self, now: float) -> None:
        work, patience_s = self._work, SILENT_S if self._position is not None else BOOT_S
        if self._trouble == HALTED:  # it says nothing more until it is reset
            if self.stops.how is not None and now - self.stops.since > SHUTDOWN_S:
                self.stops.end()
        elif now - self.heard_at > patience_s:
            raise LinkBroken(f"it has said nothing for {patience_s:g} s; is it Marlin, at this baud?")
        elif isinstance(work, Move) and not work.is_answered and now - work.sent_at > ANSWER_S:
            raise LinkBroken(f"it has not answered a move for {ANSWER_S:g} s")
        elif isinstance(work, Homing) and now - work.began_at > HOMING_S:
            self._give_up(now, "homing_has_no_end")
        elif self.firmware.has_name:
            self.stops.insist(now)
        if now >= self.query_at:
            self.query_at = now + self.settings.poll_s
            if self._position is not None and self._trouble != HALTED and self.queue.is_idle:
                self.queue.waiting.append(ASK_PLACE)
        self.queue.go_on()

    # Commands.

    def move(self, now: float, command: MoveJoints) -> None:
        if self._trouble or not self._is_homed or self._position is None:
            self.receipts.reject(command.id, self._trouble or UNHOMED)
            return
        feed = self.settings.feed(self.robot, self.settings.joints(self._position), command.q)
        self._work = Move(id=command.id, sent_at=now)
        line = f"G1{self.settings.words(command.q)}F{feed:.1f}"
        self.queue.waiting.extend(("G90", "G21", line, FINISH, ASK_PLACE))

    def home(self, now: float, command: Home) -> None:
        if self._trouble:
            self.receipts.reject(command.id, self._trouble)
            return
        self._work = Homing(id=command.id, began_at=now)
        self._is_homed = False
        self.receipts.tell(accepted=command.id)
        if self.settings.homing:
            self.queue.waiting.extend((HOME_ALL, ASK_PLACE))
        else:
            self.queue.waiting.extend((f"{ZERO_HERE} {self.settings.words_of_zero}", MOTORS_ON, ASK_PLACE))

    def halt(self, now: float) -> None:
        """Drop all moves. Homing would go on with its next leg, and believe its end: that is shut down."""
        if self._trouble == HALTED:
            if self.stops.how is None:
                self.stops.end()
            return
        if self._work is not None:
            self._is_homed = self._is_homed and self.settings.stop_keeps_place
        self._work, self.receipts.news = None, True
        self.queue.waiting = deque(each for each in self.queue.waiting if each in SETTINGS)
        self.stops.say(now, Halt.KILL if HOME_ALL in self.queue.unanswered else Halt.QUICK)

    def _give_up(self, now: float, word: str) -> None:
        """Fail the work, if there is any, and stop it: or what is left of it would go on."""
        if self._work is not None:
            self.receipts.tell(failed=self._work.id, failure=word)
            self.halt(now)

    # What it says.

    def hear(self, now: float, event: Received) -> None:
        for line in self._lines.feed(event.data):
            self.heard_at = now
            self._take(now, line)

    def _take(self, now: float, line: Line) -> None:
        if isinstance(line, Ok):
            self._take_ok(now)
        elif isinstance(line, Place):
            if self.queue.first == ASK_PLACE:
                self._place = line
        elif isinstance(line, Busy):
            self._take_busy(now, line.word)
        elif isinstance(line, Refusal):
            self._refusal = line.word
        elif isinstance(line, Trouble):
            self._take_trouble(now, line.word)
        elif isinstance(line, Capability):
            self.firmware.take_capability(line)
        elif isinstance(line, marlin_lines.Firmware):
            self.firmware.take_name(line.name)
        elif isinstance(line, Start):
            if self.is_heard:
                self.boot += 1
                self.receipts.forget()
            self._begin(now)
            self.greet(now)
        elif isinstance(line, Resend):
            raise LinkBroken("a line did not come to it as it was sent; none is sent again")

    def _take_busy(self, now: float, word: str) -> None:
        """Shut it down where it is busy with the line of a move, which it answers before it makes one.

        Then it divides the move into pieces. M410 drops those that wait, and Marlin goes on with the others.
        """
        if self._position is None and not self._trouble:
            self._moves_on = self.is_heard = self.receipts.news = True
        divides = word == "processing" and self.queue.first.startswith("G1")
        if not divides or self.stops.how is Halt.KILL:
            return
        if self._work is not None:
            self.receipts.tell(failed=self._work.id, failure="divided")
        self._work, self._is_homed, self.receipts.news = None, False, True
        self.queue.waiting.clear()
        self.stops.say(now, Halt.KILL)

    def _take_ok(self, now: float) -> None:
        if not self.firmware.has_name or not self.queue.unanswered:
            return
        line, refusal, self._refusal = self.queue.unanswered.popleft(), self._refusal, ""
        if line == ASK_NAME:
            self.firmware.check()
            self.queue.waiting.extend((*SETTINGS, ASK_PLACE))
        elif line in SETTINGS and refusal:
            raise LinkBroken(f"it does not know {line}")
        elif line == ASK_PLACE:
            place, self._place = self._place, None
            if place is None or len(place.position) < len(self.settings.axes):
                raise LinkBroken("its answer to M114 has no position for each axis")
            self._look(place.position)
        elif line in (HOME_ALL, MOTORS_ON):
            if isinstance(self._work, Homing):
                self._work.is_answered = True
                if refusal:
                    self._give_up(now, refusal)
        elif line.startswith("G1"):
            self._take_move_ok(now, refusal)
        elif line == Halt.QUICK.value and not self.queue.unanswered:
            self.queue.waiting.append(ASK_PLACE)
        self.queue.go_on()

    def _take_move_ok(self, now: float, refusal: str) -> None:
        work = self._work
        if not isinstance(work, Move):
            self.stops.say_again(now)  # the one before may have come too early for this move
        elif refusal:
            self.queue.waiting.clear()
            self.receipts.reject(work.id, refusal)
            self._work = None
            self._is_homed = self._is_homed and refusal != UNHOMED
        else:
            work.is_answered = True
            self.receipts.tell(accepted=work.id)

    def _look(self, position: tuple[float, ...]) -> None:
        """Take the place where it stands: all lines before the question have been answered."""
        self.receipts.news = self.receipts.news or position != self._position
        self._position, work = position, self._work
        if self.stops.how is not None and self.queue.unanswered:
            return  # the stop came after this question
        self.is_heard, self._moves_on = True, False
        if self.stops.how is not None:
            self.stops.end()
        elif work is not None and work.is_answered:
            self._work, self._is_homed = None, self._is_homed or isinstance(work, Homing)
            self.receipts.tell(done=work.id)

    def _take_trouble(self, now: float, word: str) -> None:
        self.receipts.news = True
        if word in (HALTED, STOPPED):
            self._trouble, self._is_homed = word, False
        if word == "endstop_hit":
            if isinstance(self._work, Homing):
                return  # which is what it looks for
            self._is_homed = False
        if word != HALTED:
            self._give_up(now, word)
            return
        self.queue.waiting.clear()
        self.queue.unanswered.clear()
        if self._work is not None:
            self.receipts.tell(failed=self._work.id, failure=word)
        self._work, self._position = None, None  # its motors go off
        self.stops.begin(now, Halt.KILL)

    # What the plant hears.

    def report(self, now: float) -> Report:
        position = None if self.is_busy else self._position
        return Report(
            at=now,
            robot=self.robot.name,
            boot_id=self.boot,
            state=self._state,
            homed=self._is_homed,
            q=None if position is None else self.settings.joints(position),
            facts=(
                (HEALTH, self._trouble or WELL),
                ("mode", self._trouble or ("busy" if self.is_busy else "idle")),
            ),
        )

    @property
    def _state(self) -> MotionState:
        if self.stops.how is not None or isinstance(self._work, Move) or self._moves_on:
            return MotionState.MOVING
        if self._trouble:
            return MotionState.FAULT
        if not self._is_homed:
            return MotionState.NOT_HOMED
        return MotionState.STOP_LATCHED if self.is_latched else MotionState.STOPPED
