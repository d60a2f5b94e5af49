"""State machine of the driver `ur`: one arm, its link, work and stops, without sockets."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.facts import HEALTH, WELL
from arboleda.model.messages import MotionState, Report
from arboleda.model.outside import plain
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, CommandNotSent, Open
from arboleda_drivers.connections.replies_due import RepliesDue
from arboleda_drivers.connections.tcp_arm import CLOCK_S, TcpArm
from arboleda_drivers.ur.port_data import Received, Send

from . import programs, rtde
from .arm_state import Runtime, hindrance, motion_state
from .primary import READ_ONLY, PackageReader, ScriptError
from .rtde import Frame, NotRtde, Packet
from .settings import SLIDER, Settings
from .work import Look, Move, Readying, Work

ASK_S = 1.0  # period of the question whether it is in remote control
BEAT_S = 0.25  # period of the heartbeat, without which the controller ends our program after 1 s
ECHO_S = 0.5  # a stop that names itself later than this is said to the dashboard, too
SWITCH_S = 1.0  # an output that has not followed by then does not
REST_RAD = 2e-4  # less than this is no motion
BOOT_S = 10  # boots are told apart by ten seconds: two clocks run apart
LOCAL = "local_control"
LONGEST_LINE = 4096
GREETING = "Universal Robots Dashboard Server"
LAST_NUMBER = 2**31 - 2  # of a register of 32 bits
BEAT = struct.Struct(">Bi")


DASHBOARD, RTDE, PRIMARY = "dashboard", "rtde", "primary"  # ports
Message = Open | Close | Send | CommandNotSent | Report


@dataclass(frozen=True, kw_only=True)
class Stopping:
    """Program of a stop that has not named itself yet."""

    id: str
    number: int
    at: float


@dataclass(frozen=True, kw_only=True)
class Switching:
    """Output that should switch and has not done so yet."""

    command: SetEffector
    at: float


class Machine(TcpArm):
    """State machine of one arm behind one controller of Universal Robots.

    One that `only_listens` writes nothing to the controller by itself.
    """

    _polled_at: float
    _beat_at: float

    def __init__(self, devices: Sequence[Robot], settings: Settings, *, only_listens: bool = False) -> None:
        """Raises ValueError unless the device is one arm of six joints."""
        self._settings, self._only_listens = settings, only_listens
        self._boot: tuple[float, float] | None = None  # when it was switched on; its own last time; s
        self._number = 0  # of the last program
        self._beats = 0
        super().__init__(devices, host=settings.host, kind="an arm of Universal Robots")

    @property
    def _link_deadline(self) -> float:
        beat = self._beat_at + BEAT_S if self._inputs is not None else math.inf
        return min(self._due.deadline, beat, self._polled_at + ASK_S)

    @property
    def _is_known(self) -> bool:
        return self._frame is not None

    @property
    def _is_at_work(self) -> bool:
        return self._work is not None

    def _hear(self, now: float, event: Received) -> None:
        try:
            if event.port == DASHBOARD:
                self._hear_lines(now, event.data)
            elif event.port == RTDE:
                for kind, payload in self._packets.feed(event.data):
                    self._hear_packet(now, kind, payload)
            else:
                for error in self._packages.feed(event.data):
                    self._hear_error(now, error)
        except ValueError as error:
            self._close(now, str(error))

    def _overdue(self, now: float) -> str:
        return self._due.overdue(now)

    def _poll(self, now: float) -> None:
        if now >= self._polled_at + ASK_S:
            self._polled_at = now
            self._say(now, "is in remote control", self._take_control)
        if self._inputs is not None and now >= self._beat_at + BEAT_S:
            self._beat_at, self._beats = now, (self._beats + 1) % LAST_NUMBER
            self._send(Packet.DATA, BEAT.pack(self._inputs, self._beats))

    # The link.

    def _greet(self, now: float) -> None:
        self._due.add(now, "the connection to its dashboard", _greeted)
        self._send(Packet.VERSION, struct.pack(">H", rtde.VERSION))

    def _forget_link(self, now: float) -> None:
        self._packets, self._packages, self._lines = rtde.PacketReader(), PackageReader(), b""
        self._due = RepliesDue[str]()
        self._work: Work | None = None
        self._frame: Frame | None = None
        self._recipe: int | None = None
        self._inputs: int | None = None
        self._stops: Stopping | None = None
        self._switches: Switching | None = None
        self._is_local = self._is_read_only = False
        self._polled_at = self._beat_at = now

    def _send(self, kind: Packet, payload: bytes = b"") -> None:
        self._out.append(Send(port=RTDE, data=rtde.packed(kind, payload)))

    def _say(self, now: float, text: str, take: Callable[[float, str], None]) -> None:
        self._due.add(now, text, take)
        self._out.append(Send(port=DASHBOARD, data=text.encode() + b"\n"))

    def _run(self, program: str) -> None:
        self._out.append(Send(port=PRIMARY, data=program.encode()))

    def _hear_lines(self, now: float, data: bytes) -> None:
        *lines, self._lines = (self._lines + data).split(b"\n")
        if len(self._lines) > LONGEST_LINE:
            raise NotRtde("a reply of its dashboard does not end")
        for line in lines:
            text = plain(line.decode("utf-8", "replace").strip(), 200)
            due = self._due.pop()
            if due is None:
                raise NotRtde(f"its dashboard says {text[:60]!r}, and nobody asked")
            due.take(now, text)

    def _hear_packet(self, now: float, kind: int, payload: bytes) -> None:
        """Take a packet: each answer of the setup leads to the next request."""
        if kind == Packet.DATA:
            frame = None if self._recipe is None else rtde.frame_of(payload, self._recipe)
            if frame is not None:
                self._look(now, frame)
        elif kind != Packet.TEXT and not payload:
            raise NotRtde(f"its RTDE answers {chr(kind)!r} with nothing")
        elif kind == Packet.VERSION:
            if payload[0] != 1:
                raise NotRtde(f"its RTDE does not speak version {rtde.VERSION}")
            names = ",".join(name for name, _ in self._wanted)
            self._send(Packet.OUTPUTS, struct.pack(">d", rtde.RATE_HZ) + names.encode())
        elif kind == Packet.OUTPUTS:
            self._recipe = rtde.recipe_of(payload, self._wanted)
            self._send(
                *((Packet.START, b"") if self._only_listens else (Packet.INPUTS, self._beat[0].encode()))
            )
        elif kind == Packet.INPUTS:
            self._inputs = rtde.recipe_of(payload, [self._beat])
            self._send(Packet.START)
        elif kind == Packet.START and payload[0] != 1:
            raise NotRtde("its RTDE does not start")

    @property
    def _wanted(self) -> tuple[tuple[str, str], ...]:
        return rtde.outputs(self._settings.registers_from)

    @property
    def _beat(self) -> tuple[str, str]:
        return (rtde.beat_name(self._settings.registers_from), rtde.REGISTER)

    def _take_control(self, now: float, reply: str) -> None:
        """Note whether it is in remote control; a CB3, which knows no such thing, always is."""
        was, self._is_local = self._is_local, reply.lower().startswith("false")
        self._news = self._news or was is not self._is_local
        if self._is_read_only and not self._is_local:
            self._close(now, "it is in remote control again, which takes a new connection")

    def _hear_error(self, now: float, error: ScriptError) -> None:
        self._is_read_only = self._is_read_only or error.code == READ_ONLY
        if isinstance(self._work, Move):
            self._work.error = self._work.error or error.text
        elif self._switches is not None:
            word = LOCAL if error.code == READ_ONLY else f"program_refused {error.text}"
            self._reject(self._switches.command.id, word)
            self._switches = None

    # Commands.

    def _move(self, now: float, command: MoveJoints) -> None:
        if self._frame is None or self._refuses_local(command.id):
            return
        number, settings = self._next_number(), self._settings
        speed, acceleration = programs.leading(self._arm.joints, self._frame.joints, command.q)
        self._work = Move(command.id, number, self._frame, now)
        text = programs.move(
            number,
            command.q,
            speed=speed * settings.speed_percent / 100,
            acceleration=acceleration * settings.acceleration_percent / 100,
            register=settings.registers_from,
        )
        self._run(text)

    def _ready(self, now: float, command: Home) -> None:
        if not self._refuses_local(command.id):
            self._work = Readying(command.id, now)
            self._tell(accepted=command.id)

    def _switch(self, now: float, command: SetEffector) -> None:
        if self._settings.output is None:
            self._out.append(CommandNotSent(why="it has no output in the plant file"))
        elif not self._refuses_local(command.id):
            self._switches = Switching(command=command, at=now)
            self._run(programs.switch(self._settings.output, on=command.on))

    def _refuses_local(self, id: str) -> bool:
        if self._is_local:
            self._reject(id, LOCAL)
        return self._is_local

    def _drop_work(self) -> None:
        self._work = None

    def _clear(self, now: float, id: str) -> None:
        self._tell(accepted=id)

    def _stop(self, now: float, id: str = "") -> None:
        """Brake by a program that takes the place of any other; what cannot move has stopped."""
        if self._frame is not None and hindrance(self._frame):
            if self._frame.runtime != Runtime.STOPPED:  # a paused program would go on once that is over
                self._say(now, "stop", _nothing)
            self._stopping_since = now
            self._tell(accepted=id)
            return
        self._stopping_since = math.inf
        self._stops = Stopping(id=id, number=self._next_number(), at=now)
        settings = self._settings
        text = programs.stop(
            self._stops.number, acceleration=settings.stop_rad_s2, register=settings.registers_from
        )
        self._run(text)

    def _next_number(self) -> int:
        """A number that no driver has given since the controller was switched on."""
        known = (self._frame.begun, self._frame.done) if self._frame is not None else ()
        self._number = max(self._number, *known, 0) % LAST_NUMBER + 1 if known else self._number + 1
        return self._number

    # What its frames show.

    def _look(self, now: float, frame: Frame) -> None:
        before = self._frame
        if before is not None and frame.timestamp_s == before.timestamp_s:
            return  # the same frame again is no news from the arm
        self._see_boot(now, frame)
        self._last_data_at, self._frame = now, frame
        if before is None:
            self._stop_what_was_left(now)
        self._see_stop(now, frame)
        still = before is not None and not _moved(before, frame) and frame.runtime == Runtime.STOPPED
        self._see_rest(now, still=still, broken=bool(hindrance(frame)))
        self._see_output(now, frame)
        if self._work is not None:
            self._go_on(now, self._work, self._work.look(now, frame))
        self._news = self._news or before is None or _shows(before) != _shows(frame)

    def _see_boot(self, now: float, frame: Frame) -> None:
        known, switched_on = self._boot, now - frame.timestamp_s
        booted = known is not None and (
            frame.timestamp_s < known[1] or (self._frame is None and abs(switched_on - known[0]) > CLOCK_S)
        )
        self._boot = (switched_on if known is None or booted else known[0], frame.timestamp_s)
        if booted:
            self._ids, self._work, self._stops, self._switches = {}, None, None, None
            self._stopping_since = None
            self._left_at_work, self._news = False, True

    def _see_stop(self, now: float, frame: Frame) -> None:
        stops = self._stops
        if stops is None:
            return
        if frame.begun == stops.number or hindrance(frame):
            self._stops, self._stopping_since = None, now
            self._tell(accepted=stops.id)
        elif now - stops.at > ECHO_S:
            self._stops = None
            self._say(now, "stop", lambda now, reply: self._take_stop(now, stops.id, reply))

    def _take_stop(self, now: float, id: str, reply: str) -> None:
        self._stopping_since = now
        if reply.lower().startswith("stopped"):
            self._tell(accepted=id)
        else:
            self._reject(id, LOCAL if self._is_local else f"stop_refused {reply[:60]}")

    def _see_output(self, now: float, frame: Frame) -> None:
        switches = self._switches
        if switches is None:
            return
        if self._is_on(frame) is switches.command.on:
            self._switches = None
            self._tell(accepted=switches.command.id)
        elif now - switches.at > SWITCH_S:
            self._switches = None
            self._reject(switches.command.id, "output_does_not_follow")

    def _is_on(self, frame: Frame) -> bool | None:
        return None if self._settings.output is None else bool(frame.outputs >> self._settings.output & 1)

    def _go_on(self, now: float, work: Work, look: Look) -> None:
        for line in look.lines:
            self._say(now, line, lambda now, reply: _note(work, reply))
        if look.accepted:
            self._tell(accepted=work.id)
        if look.done:
            self._work = None
            self._tell(done=work.id)
        elif look.failed:
            self._fail(now, work, look.failed)

    def _fail(self, now: float, work: Work, word: str) -> None:
        """Give the work up, with the reason, and stop what may be left of it."""
        self._work = None
        if work.begun:
            self._tell(failed=work.id, failure=word)
        else:
            self._reject(work.id, LOCAL if self._is_read_only else word)
        if isinstance(work, Move):
            self._stop(now)

    # What the plant hears.

    def _report(self, now: float) -> Report:
        assert self._frame is not None and self._boot is not None
        frame, readies = self._frame, isinstance(self._work, Readying)
        state = motion_state(frame)
        health = hindrance(frame) or (LOCAL if self._is_local else WELL)
        return Report(
            at=now,
            robot=self._arm.name,
            boot_id=int(self._boot[0] // BOOT_S) + LAST_NUMBER,  # the plant's host may be younger
            state=self._shown(state, readies=readies),
            homed=state is not MotionState.NOT_HOMED and not readies,
            q=frame.joints,
            effector=self._is_on(frame),
            facts=((HEALTH, health), (SLIDER, round(frame.slider * 100))),
        )


def _greeted(now: float, reply: str) -> None:
    if GREETING not in reply:
        raise NotRtde(f"its dashboard greets with {reply[:60]!r}")


def _nothing(now: float, reply: str) -> None:
    """Does nothing with a reply: the next frames show its effect."""


def _note(work: Work, reply: str) -> None:
    if isinstance(work, Readying):
        work.reply = reply


def _shows(frame: Frame) -> tuple[object, ...]:
    """The values of a frame whose change is news, beside its joints."""
    return (frame.mode, frame.safety, frame.runtime, frame.outputs, round(frame.slider * 100))


def _moved(before: Frame, after: Frame) -> bool:
    return any(abs(a - b) > REST_RAD for a, b in zip(before.joints, after.joints, strict=True))
