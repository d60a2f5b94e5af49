"""State machine of the driver `dobot`: one arm, its link, work and stops, without sockets."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.facts import HEALTH, WELL
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.connections.replies_due import RepliesDue
from arboleda_drivers.connections.tcp_arm import CLOCK_S, TcpArm

from .alarms import named
from .frames import Feedback, FrameReader, Mode
from .replies import NotAReply, Reply, ReplyReader
from .settings import Settings
from .work import ALARM, BROKEN, Look, Move, Readying, Work

ASK_S = 1.0  # period of queries of the output
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


@dataclass(frozen=True, kw_only=True)
class SendLine:
    """Message: send this text to the dashboard."""

    text: str


Event = Opened | Closed | DashboardReply | FeedbackData | CommandRequest
Message = Open | Close | SendLine | CommandNotSent | Report
Take = Callable[[float, Reply], None]


class Machine(TcpArm):
    """State machine of one arm behind one controller of Dobot."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one arm of six joints."""
        self._settings = settings
        self._boot: tuple[int, int] | None = None  # time of switching on, s; time it has run, ms
        super().__init__(devices, host=settings.host, kind="a Dobot of the CR series")

    @property
    def _link_deadline(self) -> float:
        return min(self._due.deadline, self._polled_at + ASK_S)

    @property
    def _is_known(self) -> bool:
        return self._feedback is not None

    @property
    def _is_at_work(self) -> bool:
        return self._work is not None

    def _hear(self, now: float, event: Event) -> None:
        if isinstance(event, DashboardReply):
            self._answered(now, event.data)
        elif isinstance(event, FeedbackData):
            for feedback in self._frames.feed(event.data):
                self._look(now, feedback)

    def _overdue(self, now: float) -> str:
        return self._due.overdue(now)

    def _poll(self, now: float) -> None:
        if now >= self._polled_at + ASK_S:
            self._ask_output(now)

    # The link.

    def _greet(self, now: float) -> None:
        if self._settings.request_control:
            self._ask_control(now)
        self._stop_what_was_left(now)
        self._ask_output(now)

    def _ask_control(self, now: float) -> None:
        """Ask for control; an enabled controller refuses it, so one that does is asked again when it is not.

        An older one neither knows it nor needs it.
        """

        def take(now: float, reply: Reply) -> None:
            self._lacks_control = reply.error not in (0, UNKNOWN)

        self._say(now, "RequestControl()", take)

    def _forget_link(self, now: float) -> None:
        self._frames, self._replies = FrameReader(), ReplyReader()
        self._due = RepliesDue[Reply]()
        self._work: Work | None = None
        self._failing: str | None = None
        self._feedback: Feedback | None = None
        self._effector: bool | None = None
        self._lacks_control = False
        self._polled_at = now

    def _say(self, now: float, text: str, take: Take) -> None:
        self._due.add(now, text.partition("(")[0], take)
        self._out.append(SendLine(text=text))

    def _answered(self, now: float, data: bytes) -> None:
        try:
            for reply in self._replies.feed(data):
                first = self._due.pop()
                if first is None:
                    raise NotAReply(f"nobody asked for an answer to {reply.command}")
                if reply.command and reply.command.lower() != first.name.lower():
                    raise NotAReply(self._out_of_turn(first.name, reply.command))
                first.take(now, reply)
        except NotAReply as error:
            self._close(now, str(error))

    def _out_of_turn(self, first: str, answered: str) -> str:
        """The objection to an answer that is not to the first line without one."""
        if answered.lower() in (each.lower() for each in self._due.names):
            return f"it has not answered {first}, and has answered {answered}, which it was told later"
        return f"it answers {answered} where {first} was said"

    # Commands.

    def _ready(self, now: float, command: Home) -> None:
        self._work = Readying(command.id, now)
        self._tell(accepted=command.id)

    def _move(self, now: float, command: MoveJoints) -> None:
        move = Move(command.id, lambda feedback: self._arm.motion.stands_at(_radians(feedback), command.q))
        self._work = move

        def take(now: float, reply: Reply) -> None:
            if reply.error == 0 and reply.number is None:
                raise NotAReply(f"it has taken {reply.command} without a number")
            if reply.error == 0 and reply.number is not None:
                move.taken(now, reply.number)
                self._tell(accepted=command.id)
            elif self._work is move:
                self._work = None
                self._reject(command.id, reply.word)

        self._say(now, self._settings.joint_move(command.q), take)

    def _switch(self, now: float, command: SetEffector) -> None:
        output = self._settings.tool_output
        if output is None:
            self._out.append(CommandNotSent(why="it has no tool_output in the plant file"))
            return

        def take(now: float, reply: Reply) -> None:
            if reply.error == 0:
                self._ask_output(now, command)  # accepted once it has been read back
            else:
                self._reject(command.id, reply.word)

        self._say(now, f"ToolDOInstant({output},{int(command.on)})", take)

    def _drop_work(self) -> None:
        self._work = self._failing = None

    def _clear(self, now: float, id: str) -> None:
        if self._feedback is not None and STATES[self._feedback.mode] is MotionState.FAULT:
            self._say(now, "ClearError()", lambda now, reply: self._tell(accepted=id))
        else:
            self._tell(accepted=id)

    def _stop(self, now: float, id: str = "") -> None:
        self._stopping_since = math.inf

        def take(now: float, reply: Reply) -> None:
            self._stopping_since = now
            if reply.error in UNABLE:
                self._tell(accepted=id)
            else:
                self._reject(id, reply.word)

        self._say(now, "Stop()", take)

    def _ask_output(self, now: float, switched: SetEffector | None = None) -> None:
        self._polled_at = now
        output = self._settings.tool_output
        if output is None:
            return

        def take(now: float, reply: Reply) -> None:
            on = reply.number == 1 if reply.error == 0 and reply.number in (0, 1) else None
            self._news = self._news or on is not self._effector
            self._effector = on
            if switched is not None and on is switched.on:
                self._tell(accepted=switched.id)
            elif switched is not None:
                unread = f"output_not_read_back {reply.word}"
                self._reject(switched.id, "output_does_not_follow" if reply.error == 0 else unread)

        self._say(now, f"GetToolDO({output})", take)

    # What its frames show.

    def _look(self, now: float, feedback: Feedback) -> None:
        before = self._feedback
        if before is not None and (feedback.run_ms, feedback.time_ms) == (before.run_ms, before.time_ms):
            return  # the same frame again is no news from the arm
        self._see_boot(now, feedback)
        self._last_data_at, self._feedback = now, feedback
        still = before is not None and feedback.mode is not Mode.RUNNING and not _moved(before, feedback)
        self._see_rest(now, still=still, broken=feedback.mode in BROKEN)
        if self._work is not None and self._failing is None:
            self._go_on(now, self._work, self._work.look(now, feedback))
        changes = before is None or before.mode is not feedback.mode
        if changes and self._lacks_control and feedback.mode in GIVES_CONTROL:
            self._ask_control(now)
        self._news = self._news or changes

    def _see_boot(self, now: float, feedback: Feedback) -> None:
        switched_on = max(0, (feedback.time_ms - feedback.run_ms) // 1000)
        known = self._boot
        self._boot = (switched_on, feedback.run_ms)
        if known is None:
            return
        booted = feedback.run_ms < known[1]
        if self._feedback is None:  # after a silence it may have run longer than before
            booted = booted or abs(switched_on - known[0]) > CLOCK_S
        if booted:
            self._forget_work()
            self._ask_output(now)
        else:
            self._boot = (known[0], feedback.run_ms)

    def _forget_work(self) -> None:
        self._ids, self._work, self._failing, self._effector = {}, None, None, None
        self._left_at_work, self._news = False, True

    def _go_on(self, now: float, work: Work, look: Look) -> None:
        if look.done:
            self._work = None
            self._tell(done=work.id)
        elif look.failed is not None:
            self._fail(now, work, look.failed)
        elif look.say is not None:
            self._say(now, look.say, _nothing)

    def _fail(self, now: float, work: Work, word: str) -> None:
        """Fail the work: stop the arm, ask for the controller's alarms, and report them with the reason."""
        self._failing = word
        self._stop(now)

        def take(now: float, reply: Reply) -> None:
            if self._work is work:
                alarms = named(reply.alarms)
                self._tell(
                    failed=work.id, failure=alarms if alarms and word == ALARM else f"{word} {alarms}".strip()
                )
                self._work = self._failing = None

        self._say(now, "GetErrorID()", take)

    # What the plant hears.

    def _report(self, now: float) -> Report:
        assert self._feedback is not None and self._boot is not None
        state = STATES[self._feedback.mode]
        readies = isinstance(self._work, Readying)
        # Readiness is proved by an arm that was not ready and then is.
        is_ready = state is not MotionState.NOT_HOMED and not readies
        # A failure counts once its reason is there.
        shown = MotionState.MOVING if self._failing is not None else self._shown(state, readies=readies)
        return Report(
            at=now,
            robot=self._arm.name,
            boot_id=self._boot[0],
            state=shown,
            homed=is_ready,
            q=_radians(self._feedback),
            effector=self._effector,
            facts=((HEALTH, BROKEN.get(self._feedback.mode, WELL)),),
        )


def _nothing(now: float, reply: Reply) -> None:
    """Does nothing with a reply: the next frames show its effect."""


def _radians(feedback: Feedback) -> tuple[float, ...]:
    return tuple(math.radians(each) for each in feedback.joints_deg)


def _moved(before: Feedback, after: Feedback) -> bool:
    return any(abs(a - b) > REST_DEG for a, b in zip(before.joints_deg, after.joints_deg, strict=True))
