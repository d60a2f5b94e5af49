"""Dialect of Moonraker, the server in front of Klipper: moves in pieces, by what Klipper says of its motion.

Klipper ends a queued move early only by its shutdown, which loses the place. But it always plans to a rest at
the end of the last line that it has: so a move is sent in pieces, as it goes on, and a stop sends no more.
"""

from __future__ import annotations

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.facts import HEALTH, WELL
from arboleda.model.messages import MotionState, Report

from .lines import LineReader
from .machine import ANSWER_S, HOMING_S, Machine
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
    Place,
    Status,
    parsed,
    request,
)
from .moonraker_work import Ask, Halt, Homing, Move
from .settings import LETTERS, MM

LONGEST = 65536  # bytes of a line
SILENT_S = 3.0  # Klipper answers a question within 0.25 s, or as long again where its computer is busy
AHEAD_S = 1.25  # of travel that is sent: Klipper brakes where it has less than 0.7 s, and tells it 0.5 s late
STOP_S = 3.5  # for what was sent to end; then it is shut down
DOWN_S = 1.0  # a shutdown takes milliseconds, and somewhat longer to a second controller
UNAUTHORIZED, UNAVAILABLE = 401, 503
NO_MOTION = "its status has no position of the machine; is it Klipper of 2021 or later?"
SCRIPT, QUERY = "printer.gcode.script", "printer.objects.query"
ABSOLUTE = "G90"  # the line that is harmless wherever it waits


class MoonrakerMachine(Machine):
    """State machine of a machine with Klipper behind Moonraker."""

    _told = ""  # Klipper's state when it told one last, on this line or an earlier one

    def _forget_link(self, now: float) -> None:
        super()._forget_link(now)
        self._lines: LineReader[Line] = LineReader(parsed, longest=LONGEST)
        self._number = 0
        self._asked: dict[int, Ask] = {}
        self._asked_at = now
        self._old = 0  # what was asked up to this number may tell of a time before
        self._klippy = ""
        self._motion: Motion | None = None
        self._work: Move | Homing | None = None
        self._open_halt: Halt | None = None
        self._halt_at = now

    def _greet(self, now: float) -> None:
        self._ask(
            Ask.NAME,
            "server.connection.identify",
            client_name="Arboleda",
            version="1",
            type="other",
            url="https://moonraker.readthedocs.io",
        )

    @property
    def _at_work(self) -> bool:
        return self._work is not None or self._open_halt is not None or self._waits_for(Ask.PIECE)

    def _ask(self, ask: Ask, method: str, **params: object) -> None:
        self._number += 1
        self._asked[self._number] = ask
        self._write(request(self._number, method, params))

    def _script(self, ask: Ask, *lines: str) -> None:
        self._ask(ask, SCRIPT, script="\n".join(lines))

    def _waits_for(self, *asks: Ask) -> bool:
        return any(each in asks for each in self._asked.values())

    def _wait(self, now: float) -> None:
        work, asks = self._work, self._waits_for(Ask.NAME, Ask.STATUS)
        if asks and now - self._asked_at > SILENT_S:
            self._close(now, f"it has not answered for {SILENT_S:g} s; is it Moonraker, with Klipper?")
            return
        if isinstance(work, Move) and not work.has_turn and now - work.sent_at > ANSWER_S:
            self._work = None
            self._reject(work.id, "busy_elsewhere")
        elif isinstance(work, Homing) and now - work.began_at > HOMING_S:
            self._give_up(now, "homing_has_no_end")
        elif self._open_halt is not None:
            self._go_on_stopping(now, self._open_halt)
        if now >= self._query_at:
            self._query_at = now + self._settings.poll_s
            if not asks:
                self._asked_at = now
                self._ask(Ask.STATUS, QUERY, objects=OBJECTS)

    # Commands.

    def _move(self, now: float, command: MoveJoints) -> None:
        motion, goal = self._motion, self._place(command.q)
        if motion is None or self._klippy != READY:
            self._reject(command.id, self._klippy)
        elif not self._is_homed:
            self._reject(command.id, UNHOMED)
        elif not motion.stands:
            self._reject(command.id, "not_idle")
        elif not motion.allows(goal):
            self._reject(command.id, "beyond_travel")
        else:
            feed = self._feed(self._settings.joints(motion.ordered), command.q)
            self._work = Move(
                id=command.id,
                sent_at=now,
                start=motion.ordered,
                goal=goal,
                base=motion.base,
                mm_s=feed / 60,
            )
            self._script(Ask.TURN, ABSOLUTE)
            self._work.turn = self._number

    def _place(self, q: tuple[float, ...]) -> Place:
        """The place of the machine, mm, with its axes at `q`; the others stay."""
        place = list(self._motion.ordered if self._motion is not None else (0.0, 0.0, 0.0))
        for letter, at, zero in zip(self._settings.axes, q, self._settings.zeros, strict=True):
            place[LETTERS.index(letter)] = round(at * MM + zero, 4)
        return tuple(place)

    def _home(self, now: float, command: Home) -> None:
        if self._klippy != READY or self._motion is None:
            self._reject(command.id, self._klippy)
        elif not self._motion.stands:
            self._reject(command.id, "not_idle")
        else:
            self._work = Homing(id=command.id, began_at=now)
            self._tell(accepted=command.id)
            self._script(Ask.HOME, "G28")

    def _halt(self, now: float) -> None:
        """Send no more. Homing goes to its end by itself: that is shut down."""
        homes = isinstance(self._work, Homing) and not self._work.is_answered
        self._work, self._news = None, True
        if self._klippy != READY:
            if self._open_halt is None:
                self._end_halt()
        elif homes:
            self._shut_down(now)
        elif self._open_halt is not Halt.SHUTDOWN:
            self._open_halt, self._halt_at = Halt.NO_MORE, now
            self._script(Ask.END, "M400")  # it is answered once all before it has ended

    def _shut_down(self, now: float) -> None:
        self._open_halt, self._halt_at = Halt.SHUTDOWN, now
        self._ask(Ask.SHUTDOWN, "printer.emergency_stop")

    def _go_on_stopping(self, now: float, halt: Halt) -> None:
        if self._klippy != READY:
            if now - self._halt_at > DOWN_S:
                self._end_halt()
        elif now - self._halt_at > (STOP_S if halt is Halt.NO_MORE else DOWN_S):
            self._shut_down(now)  # what it asks for is the same however often it is said

    def _end_halt(self) -> None:
        self._open_halt = None
        self._confirm_stop()

    # What it says.

    def _listen(self, now: float, data: bytes) -> None:
        for line in self._lines.feed(data):
            if not self._open:
                return
            if isinstance(line, Notice):
                self._go_down(now, line.state)
            elif (ask := self._asked.pop(line.number, None)) is not None:
                self._hear(now, ask, line)

    def _hear(self, now: float, ask: Ask, answer: Answer) -> None:
        work, refusal = self._work, answer.refusal
        if answer.code == UNAUTHORIZED or (ask is Ask.NAME and refusal is not None):
            self._close(now, f"it does not let the driver in: {(refusal or '')[:80]}")
        elif ask is Ask.STATUS:
            self._take_status(now, answer)
        elif ask in (Ask.PIECE, Ask.END):
            self._old = self._number
            if ask is Ask.PIECE and isinstance(work, Move):
                self._take_piece(now, work, answer)
        elif ask is Ask.TURN and isinstance(work, Move) and answer.number == work.turn:
            if refusal is not None:
                self._work = None
                self._reject(work.id, answer.word)
            elif self._motion is not None:
                work.has_turn = True
                self._send_pieces(work, self._motion)
        elif ask is Ask.HOME and isinstance(work, Homing):
            self._old, work.is_answered = self._number, True
            if refusal is not None:
                self._give_up(now, answer.word)

    def _take_piece(self, now: float, move: Move, answer: Answer) -> None:
        if answer.refusal is None:
            if not move.is_taken:
                move.is_taken = True
                self._tell(accepted=move.id)
        elif move.is_taken:
            self._give_up(now, answer.word)
        else:
            self._reject(move.id, answer.word)
            self._work = None

    def _take_status(self, now: float, answer: Answer) -> None:
        if answer.refusal is not None:
            if answer.code == UNAVAILABLE:
                self._go_down(now, DISCONNECTED)
            else:
                self._close(now, f"it does not tell its status: {answer.refusal[:80]}")
        elif answer.status is None or (answer.status.state == READY and answer.status.motion is None):
            self._close(now, NO_MOTION)
        elif answer.status.state != READY:
            self._go_down(now, answer.status.state)
        else:
            self._look(now, answer.status, is_new=answer.number > self._old)

    def _go_down(self, now: float, state: str) -> None:
        """Take it that Klipper is not ready: nothing that it was told goes on, and its place is lost."""
        self._is_heard, self._last_data_at = True, now
        if state == self._klippy:
            return
        was_ready, self._klippy, self._news = self._klippy in (READY, ""), state, True
        self._motion, self._left_at_work = None, False
        self._asked = {number: ask for number, ask in self._asked.items() if ask in (Ask.NAME, Ask.STATUS)}
        if state in BEGINS and self._told not in ("", *BEGINS):
            self._boot, self._receipts, self._stop_id = self._boot + 1, {}, ""
        elif self._work is not None:
            self._tell(failed=self._work.id, failure=state)
        self._work, self._told = None, state
        if was_ready:
            self._open_halt, self._halt_at = Halt.SHUTDOWN, now

    def _look(self, now: float, status: Status, *, is_new: bool) -> None:
        motion, before, work = status.motion, self._motion, self._work
        assert motion is not None
        if self._klippy not in (READY, ""):
            self._open_halt = None  # of what was before
        if self._told not in (READY, "", *BEGINS):  # and only a restart leads out of that
            self._boot, self._receipts, self._stop_id = self._boot + 1, {}, ""
        self._news = self._news or before is None or before.stands != motion.stands
        self._is_heard, self._last_data_at = True, now
        self._klippy = self._told = READY
        self._motion = motion
        if self._left_at_work:  # nobody waits for that work any more
            self._left_at_work = False
            self._halt(now)
        elif self._open_halt is Halt.NO_MORE:
            if is_new and motion.stands and not self._waits_for(Ask.PIECE, Ask.END):
                self._end_halt()
        elif isinstance(work, Homing):
            if work.is_answered and is_new and motion.stands:
                self._end_homing(work)
        elif work is not None and work.has_turn:
            self._go_on(now, work, motion, is_new=is_new)

    def _end_homing(self, homing: Homing) -> None:
        self._work = None
        if self._is_homed:
            self._tell(done=homing.id)
        else:
            self._tell(failed=homing.id, failure=UNHOMED)

    def _go_on(self, now: float, move: Move, motion: Motion, *, is_new: bool) -> None:
        if not self._is_homed:
            self._give_up(now, UNHOMED)
        elif not (move.has_sent(motion.ordered) and move.leads_by(motion.place)):
            self._give_up(now, "moved_elsewhere")  # by another client, and the next piece would lead back
        else:
            self._send_pieces(move, motion)
            if is_new and motion.stands and not self._waits_for(Ask.PIECE):
                self._work = None  # at its goal, or it has ended here
                self._tell(done=move.id)

    def _send_pieces(self, move: Move, motion: Motion) -> None:
        """Send as much as it needs not to brake, by where it has told to be."""
        ahead_mm = AHEAD_S * min(move.mm_s, motion.fastest)
        while move.sent < move.pieces and motion.ahead_s < AHEAD_S:
            if move.sent > 0 and move.sent_beyond(motion.place) >= ahead_mm:
                break
            move.sent += 1
            end = move.end_of(move.sent)
            words = "".join(
                f"{letter}{end[index] - move.base[index]:.4f}"
                for index, letter in enumerate(LETTERS[:3])
                if letter in self._settings.axes
            )
            self._script(Ask.PIECE, ABSOLUTE, f"G1{words}F{move.mm_s * 60:.1f}")

    def _give_up(self, now: float, word: str) -> None:
        """Tell that it failed. What was sent of a move ends by itself, and others may go on with theirs."""
        assert self._work is not None
        self._tell(failed=self._work.id, failure=word)
        if isinstance(self._work, Homing):
            self._halt(now)
        self._work = None

    # What the plant hears.

    @property
    def _is_homed(self) -> bool:
        homed = self._motion.homed_axes if self._motion is not None else ""
        return all(letter in homed for letter in self._settings.axes)

    @property
    def _state(self) -> MotionState:
        if self._open_halt is not None or isinstance(self._work, Move) or self._waits_for(Ask.PIECE):
            return MotionState.MOVING
        if self._motion is None:
            return MotionState.FAULT
        if isinstance(self._work, Homing):
            return MotionState.NOT_HOMED
        if not self._motion.stands:
            return MotionState.MOVING
        if not self._is_homed:
            return MotionState.NOT_HOMED
        return MotionState.STOP_LATCHED if self._latched else MotionState.STOPPED

    def _report(self, now: float) -> Report:
        motion, is_ready = self._motion, self._klippy == READY
        busy = self._at_work or (motion is not None and not motion.stands)
        return Report(
            at=now,
            robot=self._robot.name,
            boot_id=self._boot,
            state=self._state,
            homed=self._is_homed and not isinstance(self._work, Homing),
            q=None if motion is None else self._settings.joints(motion.place),
            facts=(
                (HEALTH, WELL if is_ready else self._klippy),
                ("mode", ("busy" if busy else "idle") if is_ready else self._klippy),
            ),
        )
