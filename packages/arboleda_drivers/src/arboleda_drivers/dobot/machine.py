"""State machine of the driver `dobot`: one arm, its link, work and stops, without sockets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.drivers import HEALTH, WELL, Home, MotionState, MoveJoints, Report, Robot
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.connections.receipts import Look
from arboleda_drivers.connections.tcp_arm import SILENT_S, ArmController

from .dashboard import Dashboard, SendLine, ToolOutput
from .frames import Feedback, FrameReader, Mode
from .replies import NotAReply, Reply, named
from .settings import Settings
from .work import ALARM, BROKEN, Move, Readying, Work

REST_DEG = 0.01  # less than this is no motion
UNKNOWN = -10000
GIVES_CONTROL = (Mode.POWER_OFF, Mode.DISABLED)  # where RequestControl is allowed: README_V4.pdf, 3.132
UNABLE = (0, -2, -3, -4)  # replies to a stop that was accepted, or has nothing to stop
STATES = {
    Mode.INIT: MotionState.NOT_HOMED,
    Mode.BRAKE_OPEN: MotionState.NOT_HOMED,
    Mode.POWER_OFF: MotionState.NOT_HOMED,
    Mode.DISABLED: MotionState.NOT_HOMED,
    Mode.IDLE: MotionState.STOPPED,
    Mode.DRAG: MotionState.MOVING,
    Mode.RUNNING: MotionState.MOVING,
    Mode.JOG: MotionState.MOVING,
    Mode.ERROR: MotionState.FAULT,
    Mode.PAUSED: MotionState.MOVING,  # it may be resumed at any moment by whoever paused it
    Mode.COLLISION: MotionState.FAULT,
}


@dataclass(frozen=True, kw_only=True)
class DashboardReply:
    """Event: bytes from the dashboard."""

    data: bytes


@dataclass(frozen=True, kw_only=True)
class FeedbackData:
    """Event: bytes from the feedback port."""

    data: bytes


Event = Opened | Closed | DashboardReply | FeedbackData | CommandRequest
Message = Open | Close | SendLine | CommandNotSent | Report


class Machine(ControllerMachine):
    """State machine of one arm behind one controller of Dobot."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one arm of six joints."""
        super().__init__(DobotController(devices, settings))


class DobotController(ArmController):
    """Controller of Dobot: what its frames show, and the work that it does."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        super().__init__(devices, host=settings.host, kind="a Dobot of the CR series")
        self._settings = settings

    def forget(self, now: float) -> None:
        super().forget(now)
        self.dashboard = Dashboard(self.out)
        self.effector: ToolOutput = ToolOutput(self._settings.tool_output, self.dashboard, self.receipts, now)
        self._frames = FrameReader()
        self._work: Work | None = None
        self._failing: str | None = None
        self._feedback: Feedback | None = None
        self._lacks_control = False

    @property
    def next_deadline(self) -> float:
        return min(self.dashboard.due.deadline, self.effector.next_deadline, self.frame_at + SILENT_S)

    @property
    def is_known(self) -> bool:
        return self._feedback is not None

    @property
    def is_busy(self) -> bool:
        return self._work is not None

    def greet(self, now: float) -> None:
        if self._settings.request_control:
            self._ask_control(now)
        if self.has_leftover:
            self._brake(now)
        self.has_leftover = False
        self.effector.ask(now)

    def _ask_control(self, now: float) -> None:
        """Ask for control; an enabled controller refuses it, so one that does is asked again when it is not.

        An older one neither knows it nor needs it.
        """

        def take(now: float, reply: Reply) -> None:
            self._lacks_control = reply.error not in (0, UNKNOWN)

        self.dashboard.say(now, "RequestControl()", take)

    def hear(self, now: float, event: Event) -> None:
        if isinstance(event, DashboardReply):
            self.dashboard.hear(now, event.data)
        elif isinstance(event, FeedbackData):
            for feedback in self._frames.feed(event.data):
                self._look(now, feedback)

    def pass_time(self, now: float) -> None:
        self.dashboard.due.check(now)
        self.check_silence(now)
        self.effector.pass_time(now)

    # Commands.

    def home(self, now: float, command: Home) -> None:
        self._work = Readying(command.id, now)
        self.receipts.tell(accepted=command.id)

    def move(self, now: float, command: MoveJoints) -> None:
        move = Move(command.id, lambda feedback: self.robot.motion.stands_at(_radians(feedback), command.q))
        self._work = move

        def take(now: float, reply: Reply) -> None:
            if reply.error == 0 and reply.number is None:
                raise NotAReply(f"it has taken {reply.command} without a number")
            if reply.error == 0 and reply.number is not None:
                move.taken(now, reply.number)
                self.receipts.tell(accepted=command.id)
            elif self._work is move:
                self._work = None
                self.receipts.reject(command.id, reply.word)

        self.dashboard.say(now, self._settings.joint_move(command.q), take)

    def stop(self, now: float, id: str) -> None:
        self._work = self._failing = None
        self._brake(now, id)

    def clear(self, now: float, id: str) -> None:
        if self._feedback is not None and STATES[self._feedback.mode] is MotionState.FAULT:
            self.dashboard.say(now, "ClearError()", lambda now, reply: self.receipts.tell(accepted=id))
        else:
            self.receipts.tell(accepted=id)

    def _brake(self, now: float, id: str = "") -> None:
        self.braking.begin()

        def take(now: float, reply: Reply) -> None:
            self.braking.begin(now)
            if reply.error in UNABLE:
                self.receipts.tell(accepted=id)
            else:
                self.receipts.reject(id, reply.word)

        self.dashboard.say(now, "Stop()", take)

    # What its frames show.

    def _look(self, now: float, feedback: Feedback) -> None:
        before = self._feedback
        if before is not None and (feedback.run_ms, feedback.time_ms) == (before.run_ms, before.time_ms):
            return  # the same frame again is no news from the arm
        switched_on = max(0, (feedback.time_ms - feedback.run_ms) // 1000)
        if self.boot.see(switched_on, feedback.run_ms, after_silence=before is None):
            self._forget_work(now)
        self.frame_at, self._feedback = now, feedback
        still = before is not None and feedback.mode is not Mode.RUNNING and not _moved(before, feedback)
        rests = self.braking.see(now, still=still, broken=feedback.mode in BROKEN)
        if self._work is not None and self._failing is None:
            self._go_on(now, self._work, self._work.look(now, feedback))
        changes = before is None or before.mode is not feedback.mode
        if changes and self._lacks_control and feedback.mode in GIVES_CONTROL:
            self._ask_control(now)
        self.receipts.news = self.receipts.news or rests or changes

    def _forget_work(self, now: float) -> None:
        self.receipts.forget()
        self._work, self._failing, self.effector.is_on = None, None, None
        self.has_leftover = False
        self.effector.ask(now)

    def _go_on(self, now: float, work: Work, look: Look) -> None:
        for line in look.lines:
            self.dashboard.say(now, line)
        if look.failed:
            self._fail(now, work, look.failed)
        elif look.done:
            self._work = None
            self.receipts.take(work.id, look)

    def _fail(self, now: float, work: Work, word: str) -> None:
        """Fail the work: stop the arm, ask for the controller's alarms, and report them with the reason."""
        self._failing = word
        self._brake(now)

        def take(now: float, reply: Reply) -> None:
            if self._work is work:
                alarms = named(reply.alarms)
                self.receipts.tell(
                    failed=work.id, failure=alarms if alarms and word == ALARM else f"{word} {alarms}".strip()
                )
                self._work = self._failing = None

        self.dashboard.say(now, "GetErrorID()", take)

    # What the plant hears.

    def report(self, now: float) -> Report:
        assert self._feedback is not None
        state = STATES[self._feedback.mode]
        readies = isinstance(self._work, Readying)
        # Readiness is proved by an arm that was not ready and then is.
        is_ready = state is not MotionState.NOT_HOMED and not readies
        # A failure counts once its reason is there.
        shown = MotionState.MOVING if self._failing is not None else self.shown(state, readies=readies)
        return Report(
            at=now,
            robot=self.robot.name,
            boot_id=int(self.boot.at),
            state=shown,
            homed=is_ready,
            q=_radians(self._feedback),
            effector=self.effector.is_on,
            facts=((HEALTH, BROKEN.get(self._feedback.mode, WELL)),),
        )


def _radians(feedback: Feedback) -> tuple[float, ...]:
    return tuple(math.radians(each) for each in feedback.joints_deg)


def _moved(before: Feedback, after: Feedback) -> bool:
    return any(abs(a - b) > REST_DEG for a, b in zip(before.joints_deg, after.joints_deg, strict=True))
