"""State machine of the driver `dobot`: one arm, its link, work and stops, without sockets."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from arboleda.drivers.port import lost
from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState, Robot

from .alarms import named
from .frames import Feedback, FrameReader, Mode
from .replies import NotAReply, Reply, ReplyReader
from .settings import Settings
from .work import ALARM, BROKEN, SETTLE_S, Look, Move, Readying, Work

AGAIN_S = 0.5  # between two tries to connect
REPLY_S = 2.0  # a controller answers in milliseconds
SILENT_S = 1.0  # it sends a frame every 8 ms
REPORT_S = 0.1  # a report at least so often
ASK_S = 1.0  # period of queries of the output
CLOCK_S = 2  # the controller's clock may be corrected by less between two connections
REST_DEG = 0.01  # less than this is no motion
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
class ConnectionsOpened:
    """Event: both connections are open."""


@dataclass(frozen=True, kw_only=True)
class Closed:
    """Event: one connection broke, or could not be made; the other one has been closed as well."""

    why: str


@dataclass(frozen=True, kw_only=True)
class DashboardReply:
    """Event: bytes from the dashboard."""

    data: bytes


@dataclass(frozen=True, kw_only=True)
class FeedbackData:
    """Event: bytes from the feedback port."""

    data: bytes


@dataclass(frozen=True, kw_only=True)
class CommandRequest:
    """Event: the plant commands the arm."""

    command: Command


@dataclass(frozen=True, kw_only=True)
class Open:
    """Message: connect to both ports."""


@dataclass(frozen=True, kw_only=True)
class Close:
    """Message: close both connections."""


@dataclass(frozen=True, kw_only=True)
class SendLine:
    """Message: send this text to the dashboard."""

    text: str


@dataclass(frozen=True, kw_only=True)
class CommandNotSent:
    """Message: the command that the plant gave cannot leave."""

    why: str


Event = ConnectionsOpened | Closed | DashboardReply | FeedbackData | CommandRequest
Message = Open | Close | SendLine | CommandNotSent | Report
Take = Callable[[float, Reply], None]


@dataclass(frozen=True, kw_only=True)
class Pending:
    """Line to which the controller has not replied yet."""

    name: str
    at: float
    take: Take


class Machine:
    """State machine of one arm behind one controller; `step` takes events and returns actions and reports."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one arm of six joints."""
        if len(devices) != 1 or not isinstance(devices[0], Arm) or len(devices[0].joints) != 6:
            raise ValueError("a Dobot of the CR series is one arm of six joints")
        self._arm = devices[0]
        self._settings = settings
        self._out: list[Message] = []
        self._open = False
        self._open_at = -math.inf
        self._boot: tuple[int, int] | None = None  # time of switching on, s; time it has run, ms
        self._latched = False
        self._left_at_work = False
        self._news = False
        self._reported_at = -math.inf
        self._ids: dict[str, str] = {}
        self._forget_link(0.0)

    @property
    def next_deadline(self) -> float:
        """The time (s) at which `step` is due even without events."""
        if not self._open:
            return self._open_at
        answer = self._pending[0].at + REPLY_S if self._pending else math.inf
        return min(answer, self._heard_at + SILENT_S, self._asked_at + ASK_S)

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events and the time, and return messages to act on; at most one is a report of the arm."""
        for event in events:
            self._take(now, event)
        self._pass_time(now)
        if self._open and self._feedback is not None and (self._news or now >= self._reported_at + REPORT_S):
            self._out.append(self._report(now))
        out, self._out = self._out, []
        return out

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, CommandRequest):
            self._ask(now, event.command)
        elif isinstance(event, ConnectionsOpened):
            self._opened(now)
        elif isinstance(event, Closed):
            if self._open or self._open_at == math.inf:  # else it was closed from here
                self._lose(now, event.why)
        elif self._open and isinstance(event, DashboardReply):
            self._answered(now, event.data)
        elif self._open and isinstance(event, FeedbackData):
            for feedback in self._frames.feed(event.data):
                self._look(now, feedback)

    def _pass_time(self, now: float) -> None:
        if not self._open:
            if self._open_at <= now:
                self._open_at = math.inf
                self._out.append(Open())
        elif self._pending and now >= self._pending[0].at + REPLY_S:
            self._close(now, f"it has not answered {self._pending[0].name} for {REPLY_S:g} s")
        elif now >= self._heard_at + SILENT_S:
            self._close(now, f"its feedback has stood still for {SILENT_S:g} s")
        elif now >= self._asked_at + ASK_S:
            self._ask_output(now)

    # The link.

    def _opened(self, now: float) -> None:
        self._forget_link(now)
        self._open = True
        if self._settings.request_control:
            self._say(now, "RequestControl()", _nothing)  # an older controller neither knows nor needs it
        if self._left_at_work:  # nobody waits for that work any more
            self._stop(now)
        self._left_at_work = False
        self._ask_output(now)

    def _close(self, now: float, why: str) -> None:
        self._out.append(Close())
        self._lose(now, why)

    def _lose(self, now: float, why: str) -> None:
        self._left_at_work = self._left_at_work or self._work is not None
        self._open, self._open_at = False, now + AGAIN_S
        self._forget_link(now)
        self._out.append(lost(self._arm.name, at=now, why=f"{self._settings.host}: {why}"))

    def _forget_link(self, now: float) -> None:
        self._frames, self._replies = FrameReader(), ReplyReader()
        self._pending: deque[Pending] = deque()
        self._work: Work | None = None
        self._failing: str | None = None
        self._feedback: Feedback | None = None
        self._rest_since: float | None = None
        self._stopping_since: float | None = None  # inf: the stop is not answered yet
        self._effector: bool | None = None
        self._heard_at = self._asked_at = now

    def _say(self, now: float, text: str, take: Take) -> None:
        self._pending.append(Pending(name=text.partition("(")[0], at=now, take=take))
        self._out.append(SendLine(text=text))

    def _answered(self, now: float, data: bytes) -> None:
        try:
            for reply in self._replies.feed(data):
                if not self._pending:
                    raise NotAReply(f"nobody asked for an answer to {reply.command}")
                first = self._pending.popleft()
                if reply.command and reply.command.lower() != first.name.lower():
                    raise NotAReply(f"it answers {reply.command} where {first.name} was said")
                first.take(now, reply)
        except NotAReply as error:
            self._close(now, str(error))

    # What it is told.

    def _ask(self, now: float, command: Command) -> None:
        if not self._open:
            self._out.append(CommandNotSent(why=f"{self._settings.host} is not connected"))
        elif isinstance(command, Stop):
            self._ask_stop(now, command)
        elif isinstance(command, SetEffector):
            self._switch(now, command)
        elif self._work is not None:
            self._reject(command.id, "busy")
        elif isinstance(command, MoveJoints):
            self._move(now, command)
        elif isinstance(command, Home):
            self._work = Readying(command.id, now)
            self._tell(accepted=command.id)
        else:
            self._out.append(CommandNotSent(why=f"a Dobot has no word for {type(command).__name__}"))

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

    def _ask_stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
            self._news = True
        if command.mode is not StopMode.CLEAR:
            self._work = self._failing = None
            self._stop(now, command.id)
        elif self._feedback is not None and STATES[self._feedback.mode] is MotionState.FAULT:
            self._say(now, "ClearError()", lambda now, reply: self._tell(accepted=command.id))
        else:
            self._tell(accepted=command.id)

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
        self._asked_at = now
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
                self._reject(switched.id, "output_does_not_follow")

        self._say(now, f"GetToolDO({output})", take)

    # What its frames show.

    def _look(self, now: float, feedback: Feedback) -> None:
        before = self._feedback
        if before is not None and feedback.run_ms == before.run_ms:
            return  # the same frame again is no news from the arm
        self._see_boot(now, feedback)
        self._heard_at, self._feedback = now, feedback
        self._see_rest(now, before, feedback)
        if self._work is not None and self._failing is None:
            self._go_on(now, self._work, self._work.look(now, feedback))
        self._news = self._news or before is None or before.mode is not feedback.mode

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

    def _see_rest(self, now: float, before: Feedback | None, feedback: Feedback) -> None:
        still = before is not None and feedback.mode is not Mode.RUNNING and not _moved(before, feedback)
        self._rest_since = (self._rest_since or now) if still else None
        if self._stopping_since is None:
            return
        rests = self._rest_since is not None and now - max(self._rest_since, self._stopping_since) >= SETTLE_S
        if rests or feedback.mode in BROKEN:
            self._stopping_since, self._news = None, True

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

    def _tell(self, **ids: str) -> None:
        self._ids |= {name: id for name, id in ids.items() if id}
        self._news = True

    def _reject(self, id: str, word: str) -> None:
        if id:
            self._tell(rejected=id, refusal=word)

    def _state(self, feedback: Feedback) -> MotionState:
        state = STATES[feedback.mode]
        if self._failing is not None:
            return MotionState.MOVING  # until the reason is there
        if isinstance(self._work, Readying) and state is MotionState.FAULT:
            return MotionState.NOT_HOMED  # it is being made ready
        if state is not MotionState.STOPPED:
            return state
        if self._work is not None or self._stopping_since is not None:
            return MotionState.MOVING  # it may begin to move at any moment, or has not come to rest
        return MotionState.STOP_LATCHED if self._latched else state

    def _report(self, now: float) -> Report:
        assert self._feedback is not None and self._boot is not None
        self._news, self._reported_at = False, now
        state = self._state(self._feedback)
        # Readiness is proved by an arm that was not ready and then is.
        is_ready = STATES[self._feedback.mode] is not MotionState.NOT_HOMED and not isinstance(
            self._work, Readying
        )
        said = Report(
            at=now,
            robot=self._arm.name,
            boot_id=self._boot[0],
            state=state,
            homed=is_ready,
            q=_radians(self._feedback),
            effector=self._effector,
        )
        return said.again(now, **self._ids)


def _nothing(now: float, reply: Reply) -> None:
    """Does nothing with a reply: the next frames show its effect."""


def _radians(feedback: Feedback) -> tuple[float, ...]:
    return tuple(math.radians(each) for each in feedback.joints_deg)


def _moved(before: Feedback, after: Feedback) -> bool:
    return any(abs(a - b) > REST_DEG for a, b in zip(before.joints_deg, after.joints_deg, strict=True))
