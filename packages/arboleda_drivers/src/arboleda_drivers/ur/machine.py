"""State machine of the driver `ur`: one arm, its link, work and stops, without sockets."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.drivers import HEALTH, WELL, Home, MotionState, MoveJoints, Report, Robot
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.link import Close, CommandNotSent, Open
from arboleda_drivers.connections.receipts import Look
from arboleda_drivers.connections.tcp_arm import SILENT_S, ArmController
from arboleda_drivers.ur.port_data import DASHBOARD, RTDE, Received, Send

from . import programs
from .arm_state import Runtime, hindrance, motion_state
from .dashboard import LOCAL, Dashboard
from .output import Output
from .primary import READ_ONLY, PackageReader, ScriptError
from .programs import LAST_NUMBER, ProgramPort
from .rtde import Frame
from .rtde_client import RtdeClient
from .settings import SLIDER, Settings
from .stop_program import StopProgram
from .work import Move, Readying, Work

REST_RAD = 2e-4  # less than this is no motion
BOOT_S = 10  # boots are told apart by ten seconds: two clocks run apart
Message = Open | Close | Send | CommandNotSent | Report


class Machine(ControllerMachine):
    """State machine of one arm behind one controller of Universal Robots.

    One that `only_listens` writes nothing to the controller by itself.
    """

    def __init__(self, devices: Sequence[Robot], settings: Settings, *, only_listens: bool = False) -> None:
        """Raises ValueError unless the device is one arm of six joints."""
        super().__init__(UrController(devices, settings, only_listens=only_listens))


class UrController(ArmController):
    """Controller of Universal Robots: what its frames show, and the work that it does."""

    def __init__(self, devices: Sequence[Robot], settings: Settings, *, only_listens: bool) -> None:
        super().__init__(devices, host=settings.host, kind="an arm of Universal Robots")
        self._settings, self._only_listens = settings, only_listens
        self.port = ProgramPort(self.out)

    def forget(self, now: float) -> None:
        super().forget(now)
        self.dashboard = Dashboard(self.out, self.receipts, now)
        self.rtde = RtdeClient(self.out, self._settings.registers_from, now, only_listens=self._only_listens)
        self.stops = StopProgram(self._settings, self.port, self.dashboard, self.braking, self.receipts)
        self.effector: Output = Output(self._settings.output, self.port, self.dashboard, self.receipts)
        self._packages = PackageReader()
        self._work: Work | None = None
        self._frame: Frame | None = None

    @property
    def next_deadline(self) -> float:
        return min(self.dashboard.next_deadline, self.rtde.next_deadline, self.frame_at + SILENT_S)

    @property
    def is_known(self) -> bool:
        return self._frame is not None

    @property
    def is_busy(self) -> bool:
        return self._work is not None

    def greet(self, now: float) -> None:
        self.dashboard.greet(now)
        self.rtde.greet()

    def hear(self, now: float, event: Received) -> None:
        if event.port == DASHBOARD:
            self.dashboard.hear(now, event.data)
        elif event.port == RTDE:
            for frame in self.rtde.hear(event.data):
                self._look(now, frame)
        else:
            for error in self._packages.feed(event.data):
                self._hear_error(error)

    def pass_time(self, now: float) -> None:
        self.dashboard.due.check(now)
        self.check_silence(now)
        self.dashboard.ask_control(now)
        self.rtde.pass_time(now)

    def _hear_error(self, error: ScriptError) -> None:
        self.dashboard.is_read_only = self.dashboard.is_read_only or error.code == READ_ONLY
        if isinstance(self._work, Move):
            self._work.error = self._work.error or error.text
        else:
            self.effector.refuse(error)

    # Commands.

    def move(self, now: float, command: MoveJoints) -> None:
        if self._frame is None or self.dashboard.rejects(command.id):
            return
        number, settings = self.port.next_number(self._frame), self._settings
        speed, acceleration = programs.leading(self.robot.joints, self._frame.joints, command.q)
        self._work = Move(command.id, number, self._frame, now)
        text = programs.move(
            number,
            command.q,
            speed=speed * settings.speed_percent / 100,
            acceleration=acceleration * settings.acceleration_percent / 100,
            register=settings.registers_from,
        )
        self.port.run(text)

    def home(self, now: float, command: Home) -> None:
        if not self.dashboard.rejects(command.id):
            self._work = Readying(command.id, now)
            self.receipts.tell(accepted=command.id)

    def stop(self, now: float, id: str) -> None:
        self._work = None
        self.stops.run(now, id, self._frame)

    # What its frames show.

    def _look(self, now: float, frame: Frame) -> None:
        before, receipts = self._frame, self.receipts
        if before is not None and frame.timestamp_s == before.timestamp_s:
            return  # the same frame again is no news from the arm
        if self.boot.see(now - frame.timestamp_s, frame.timestamp_s, after_silence=before is None):
            self._forget_work()
        self.frame_at, self._frame = now, frame
        if before is None and self.has_leftover:
            self.stops.run(now, "", frame)
            self.has_leftover = False
        self.stops.see(now, frame)
        still = before is not None and not _moved(before, frame) and frame.runtime == Runtime.STOPPED
        rests = self.braking.see(now, still=still, broken=bool(hindrance(frame)))
        self.effector.see(now, frame)
        if self._work is not None:
            self._go_on(now, self._work, self._work.look(now, frame))
        receipts.news = receipts.news or rests or before is None or _shows(before) != _shows(frame)

    def _forget_work(self) -> None:
        self.receipts.forget()
        self._work, self.stops.sent = None, None
        self.effector.forget()
        self.braking.end()
        self.has_leftover = False

    def _go_on(self, now: float, work: Work, look: Look) -> None:
        for line in look.lines:
            self.dashboard.say(now, line, lambda now, reply: _note(work, reply))
        if look.failed and not work.begun:
            look = Look(refused=LOCAL if self.dashboard.is_read_only else look.failed)
        self.receipts.take(work.id, look)
        if look.is_end:
            self._work = None
        if look.is_end and not look.done and isinstance(work, Move):
            self.stops.run(now, "", self._frame)  # what may be left of it

    # What the plant hears.

    def report(self, now: float) -> Report:
        assert self._frame is not None
        frame, readies = self._frame, isinstance(self._work, Readying)
        state = motion_state(frame)
        health = hindrance(frame) or (LOCAL if self.dashboard.is_local else WELL)
        return Report(
            at=now,
            robot=self.robot.name,
            boot_id=int(self.boot.at // BOOT_S) + LAST_NUMBER,  # the plant's host may be younger
            state=self.shown(state, readies=readies),
            homed=state is not MotionState.NOT_HOMED and not readies,
            q=frame.joints,
            effector=self.effector.is_on(frame),
            facts=((HEALTH, health), (SLIDER, round(frame.slider * 100))),
        )


def _note(work: Work, reply: str) -> None:
    if isinstance(work, Readying):
        work.reply = reply


def _shows(frame: Frame) -> tuple[object, ...]:
    """The values of a frame whose change is news, beside its joints."""
    return (frame.mode, frame.safety, frame.runtime, frame.outputs, round(frame.slider * 100))


def _moved(before: Frame, after: Frame) -> bool:
    return any(abs(a - b) > REST_RAD for a, b in zip(before.joints, after.joints, strict=True))
