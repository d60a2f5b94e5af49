"""Dialect of Marlin: one line after another, each with its answer, and stops that pass them.

`M400` waits until all moves have ended, and only then does `M114` tell where the machine is: before, it tells
where the last move will end. So nothing is known of the place under way.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.facts import HEALTH, WELL
from arboleda.model.messages import MotionState, Report

from .lines import LineReader
from .machine import ANSWER_S, HOMING_S, Machine
from .marlin_lines import (
    HALTED,
    STOPPED,
    UNHOMED,
    Busy,
    Capability,
    Firmware,
    Line,
    Ok,
    Place,
    Refusal,
    Resend,
    Start,
    Trouble,
    numbered,
    parsed,
)

SILENT_S = 3.0  # a busy controller says so once a second
BOOT_S = 10.0  # a board boots when its line is opened, some with a picture on their screen
STOP_AGAIN_S = 3.0  # Marlin drops all moves for a second, and for one more after a second stop
SHUTDOWN_S = 2.0  # it moves on for 0.6 s after it says that it is halted, longer the faster it steps
SET_NUMBER, ASK_NAME, ASK_PLACE, FINISH, HOME_ALL, MOTORS_ON = "M110 N0", "M115", "M114", "M400", "G28", "M17"
SETTINGS = ("M113 S1", "M84 S0")  # a sign of life each second; motors that never go off by themselves
PARSER = "EMERGENCY_PARSER"
NO_PARSER = (
    f"its M115 does not say {PARSER}:1, so a stop would wait behind what it is to stop; build the firmware "
    "with it"
)


class Halt(Enum):
    """Stop of Marlin, by its line."""

    QUICK = "M410"
    KILL = "M112"


@dataclass(kw_only=True)
class Move:
    """Move: taken when its line is answered, over when the place after that is known."""

    id: str
    sent_at: float
    is_taken: bool = False


@dataclass(kw_only=True)
class Homing:
    """Homing cycle, and its answer."""

    id: str
    began_at: float
    is_answered: bool = False


class MarlinMachine(Machine):
    """State machine of a machine with Marlin."""

    def _forget_link(self, now: float) -> None:
        super()._forget_link(now)
        self._lines: LineReader[Line] = LineReader(parsed)
        self._begin(now)

    def _begin(self, now: float) -> None:
        """Know nothing of the controller: after a boot, or where nobody knows what happened meanwhile."""
        self._last_data_at = now
        self._queue: deque[str] = deque()  # lines that wait for the answer to those before
        self._unanswered: deque[str] = deque()  # lines without an answer
        self._number = 0
        self._has_name = self._has_parser = self._is_homed = False
        self._moves_on = False  # it is at lines that nobody sent on this connection
        self._position: tuple[float, ...] | None = None
        self._place: Place | None = None  # of the answer that is under way
        self._refusal = self._trouble = ""
        self._work: Move | Homing | None = None
        self._open_halt: Halt | None = None
        self._halt_at = now

    def _greet(self, now: float) -> None:
        self._write("")  # what was left of a line that was torn ends here, and takes no stop with it
        if self._left_at_work:  # nobody waits for that work any more
            self._left_at_work = False
            self._say_halt(now, Halt.QUICK)
        self._ask(SET_NUMBER)
        self._unanswered.append(ASK_NAME)  # without a number: once Marlin comes to do M110 it counts anew,
        self._write(ASK_NAME)  # and refuses what follows a line that it has read meanwhile

    @property
    def _at_work(self) -> bool:
        return self._work is not None or self._open_halt is not None or self._moves_on

    def _ask(self, line: str) -> None:
        self._unanswered.append(line)
        self._write(numbered(self._number, line))
        self._number += 1

    def _go_on(self) -> None:
        if self._queue and not self._unanswered:
            self._ask(self._queue.popleft())

    def _wait(self, now: float) -> None:
        patience_s = SILENT_S if self._position is not None else BOOT_S
        if self._trouble == HALTED:  # it says nothing more until it is reset
            if self._open_halt is not None and now - self._halt_at > SHUTDOWN_S:
                self._end_halt()
        elif now - self._last_data_at > patience_s:
            self._close(now, f"it has said nothing for {patience_s:g} s; is it Marlin, at this baud?")
            return
        elif isinstance(self._work, Move) and not self._work.is_taken and now - self._work.sent_at > ANSWER_S:
            self._close(now, f"it has not answered a move for {ANSWER_S:g} s")
            return
        elif isinstance(self._work, Homing) and now - self._work.began_at > HOMING_S:
            self._give_up(now, "homing_has_no_end")
        elif self._has_name and self._open_halt is not None and now - self._halt_at > STOP_AGAIN_S:
            self._say_halt(now, self._open_halt)  # what it asks for is the same however often it is said
        if now >= self._query_at:
            self._query_at = now + self._settings.poll_s
            if (
                self._position is not None
                and self._trouble != HALTED
                and not self._queue
                and not self._unanswered
            ):
                self._queue.append(ASK_PLACE)
        self._go_on()

    # Commands.

    def _move(self, now: float, command: MoveJoints) -> None:
        if self._trouble or not self._is_homed or self._position is None:
            self._reject(command.id, self._trouble or UNHOMED)
            return
        feed = self._feed(self._settings.joints(self._position), command.q)
        self._work = Move(id=command.id, sent_at=now)
        self._queue.extend(
            ("G90", "G21", f"G1{self._settings.words(command.q)}F{feed:.1f}", FINISH, ASK_PLACE)
        )

    def _home(self, now: float, command: Home) -> None:
        if self._trouble:
            self._reject(command.id, self._trouble)
            return
        self._work = Homing(id=command.id, began_at=now)
        self._is_homed = False
        self._tell(accepted=command.id)
        self._queue.extend((HOME_ALL if self._settings.homing else MOTORS_ON, ASK_PLACE))

    def _halt(self, now: float) -> None:
        """Drop all moves. Homing would go on with its next leg, and believe its end: that is shut down."""
        if self._trouble == HALTED:
            if self._open_halt is None:
                self._end_halt()
            return
        if self._work is not None:
            self._is_homed = self._is_homed and self._settings.stop_keeps_place
        self._work, self._news = None, True
        self._queue = deque(each for each in self._queue if each in SETTINGS)
        self._say_halt(now, Halt.KILL if HOME_ALL in self._unanswered else Halt.QUICK)

    def _say_halt(self, now: float, halt: Halt) -> None:
        self._open_halt, self._halt_at = halt, now
        self._unanswered.append(halt.value)
        self._write(halt.value)  # without a number: it passes lines that were lost or are not read yet

    def _end_halt(self) -> None:
        self._open_halt = None
        self._confirm_stop()

    # What it says.

    def _listen(self, now: float, data: bytes) -> None:
        for line in self._lines.feed(data):
            if self._open:
                self._last_data_at = now
                self._hear(now, line)

    def _hear(self, now: float, line: Line) -> None:
        if isinstance(line, Ok):
            self._take_ok(now)
        elif isinstance(line, Place):
            if self._unanswered and self._unanswered[0] == ASK_PLACE:
                self._place = line
        elif isinstance(line, Busy):
            self._take_busy(now, line.word)
        elif isinstance(line, Refusal):
            self._refusal = line.word
        elif isinstance(line, Trouble):
            self._take_trouble(now, line.word)
        elif isinstance(line, Capability):
            self._has_parser = self._has_parser or (line.name == PARSER and line.on)
        elif isinstance(line, Firmware):
            self._take_name(now, line.name)
        elif isinstance(line, Start):
            self._take_start(now)
        elif isinstance(line, Resend):
            self._close(now, "a line did not come to it as it was sent; none is sent again")

    def _take_busy(self, now: float, word: str) -> None:
        """Shut it down where it is busy with the line of a move, which it answers before it makes one.

        Then it divides the move into pieces. M410 drops those that wait, and Marlin goes on with the others.
        """
        if self._position is None and not self._trouble:
            self._moves_on = self._is_heard = self._news = True
        divides = word == "processing" and bool(self._unanswered) and self._unanswered[0].startswith("G1")
        if not divides or self._open_halt is Halt.KILL:
            return
        if self._work is not None:
            self._tell(failed=self._work.id, failure="divided")
        self._work, self._is_homed, self._news = None, False, True
        self._queue.clear()
        self._say_halt(now, Halt.KILL)

    def _take_start(self, now: float) -> None:
        if self._is_heard:
            self._boot += 1
            self._receipts, self._stop_id, self._news = {}, "", True
        self._begin(now)
        self._greet(now)

    def _take_name(self, now: float, name: str) -> None:
        """Take the name: all answers before this one are those to lines of an earlier connection."""
        if self._has_name or ASK_NAME not in self._unanswered:
            self._close(now, "it has told its name without being asked")
        elif not name.startswith("Marlin"):
            self._close(now, f"it is no Marlin, it says {name[:40]}")
        else:
            self._has_name = True
            while self._unanswered[0] != ASK_NAME:
                self._unanswered.popleft()

    def _take_ok(self, now: float) -> None:
        if not self._has_name or not self._unanswered:
            return
        line, refusal, self._refusal = self._unanswered.popleft(), self._refusal, ""
        if line == ASK_NAME:
            if not self._has_parser:
                self._close(now, NO_PARSER)
                return
            self._queue.extend((*SETTINGS, ASK_PLACE))
        elif line in SETTINGS and refusal:
            self._close(now, f"it does not know {line}")
            return
        elif line == ASK_PLACE:
            place, self._place = self._place, None
            if place is None or len(place.position) < len(self._settings.axes):
                self._close(now, "its answer to M114 has no position for each axis")
                return
            self._look(now, place.position)
        elif line in (HOME_ALL, MOTORS_ON):
            self._take_homing_ok(now, refusal)
        elif line.startswith("G1"):
            self._take_move_ok(now, refusal)
        elif line == Halt.QUICK.value and not self._unanswered:
            self._queue.append(ASK_PLACE)
        self._go_on()

    def _take_homing_ok(self, now: float, refusal: str) -> None:
        if isinstance(self._work, Homing):
            self._work.is_answered = True
            if refusal:
                self._give_up(now, refusal)

    def _take_move_ok(self, now: float, refusal: str) -> None:
        if isinstance(self._work, Move):
            if refusal:
                self._queue.clear()
                self._reject(self._work.id, refusal)
                self._work = None
                self._is_homed = self._is_homed and refusal != UNHOMED
            else:
                self._work.is_taken = True
                self._tell(accepted=self._work.id)
        elif self._open_halt is not None:
            self._say_halt(now, self._open_halt)  # the one before may have come too early for this move

    def _look(self, now: float, position: tuple[float, ...]) -> None:
        """Take the place where it stands: all lines before the question have been answered."""
        self._news = self._news or position != self._position
        self._position, work = position, self._work
        if self._open_halt is not None and self._unanswered:
            return  # the stop came after this question
        self._is_heard, self._moves_on = True, False
        if self._open_halt is not None:
            self._end_halt()
        elif isinstance(work, Homing) and work.is_answered:
            self._work, self._is_homed = None, True
            self._tell(done=work.id)
        elif isinstance(work, Move) and work.is_taken:
            self._work = None
            self._tell(done=work.id)

    def _take_trouble(self, now: float, word: str) -> None:
        self._news = True
        if word in (HALTED, STOPPED):
            self._trouble, self._is_homed = word, False
        if word == "endstop_hit":
            if isinstance(self._work, Homing):
                return  # which is what it looks for
            self._is_homed = False
        if word == HALTED:
            self._queue.clear()
            self._unanswered.clear()
            if self._work is not None:
                self._tell(failed=self._work.id, failure=word)
                self._work = None
            self._position = None  # its motors go off
            self._open_halt, self._halt_at = Halt.KILL, now
        elif self._work is not None:
            self._give_up(now, word)

    def _give_up(self, now: float, word: str) -> None:
        assert self._work is not None
        self._tell(failed=self._work.id, failure=word)
        self._halt(now)  # or what is left of it would go on

    # What the plant hears.

    def _report(self, now: float) -> Report:
        position = None if self._at_work else self._position
        return Report(
            at=now,
            robot=self._robot.name,
            boot_id=self._boot,
            state=self._state,
            homed=self._is_homed,
            q=None if position is None else self._settings.joints(position),
            facts=(
                (HEALTH, self._trouble or WELL),
                ("mode", self._trouble or ("busy" if self._at_work else "idle")),
            ),
        )

    @property
    def _state(self) -> MotionState:
        if self._open_halt is not None or isinstance(self._work, Move) or self._moves_on:
            return MotionState.MOVING
        if self._trouble:
            return MotionState.FAULT
        if not self._is_homed:
            return MotionState.NOT_HOMED
        return MotionState.STOP_LATCHED if self._latched else MotionState.STOPPED
