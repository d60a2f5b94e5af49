"""What the driver makes of an action server and of joint states: one arm, its goal and its stops."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, auto

from arboleda.drivers.port import lost
from arboleda.kinds.arm import Arm, MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import Report
from arboleda.model.outside import plain
from arboleda.model.plant_model import MotionState, Robot

from .goal import Goal, Rest
from .settings import Settings

ANSWER_S = 2.0  # a server answers a goal or a cancel in milliseconds
GONE_S = 1.0  # a server that is started anew is away for a moment, and discovery takes another
SILENT_S = 1.0  # joint states come many times a second
REPORT_S = 0.1  # a report at least so often
LONGEST_WORD = 120
ERRORS = {
    -1: "invalid_goal",
    -2: "invalid_joints",
    -3: "old_time_stamp",
    -4: "path_tolerance_violated",
    -5: "goal_tolerance_violated",
}
"""What the controller means by an error_code, in a word for the plant."""


class Status(Enum):
    """How a goal ended."""

    SUCCEEDED = auto()
    ABORTED = auto()
    CANCELED = auto()
    UNKNOWN = auto()  # the server does not know the goal


@dataclass(frozen=True, kw_only=True)
class Found:
    """The servers of the action now, each by a number of its own; it changes where one was started anew."""

    servers: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class JointsSeen:
    """A joint state; `stamp` is when the robot says that it was measured, in whatever clock."""

    names: tuple[str, ...]
    positions: tuple[float, ...]
    stamp: tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class Answered:
    """The server has accepted a goal, or refused it."""

    id: str
    accepted: bool


@dataclass(frozen=True, kw_only=True)
class Ended:
    """The result of a goal has come."""

    id: str
    status: Status
    error: int = 0
    text: str = ""


@dataclass(frozen=True, kw_only=True)
class CancelAnswered:
    """The server has answered that all of its goals be cancelled."""

    refused: bool


@dataclass(frozen=True, kw_only=True)
class Asked:
    """The plant commands the arm."""

    command: Command


@dataclass(frozen=True, kw_only=True)
class SendGoal:
    """Send the server a goal of one point."""

    id: str
    joints: tuple[str, ...]
    q: tuple[float, ...]
    duration_s: float


@dataclass(frozen=True, kw_only=True)
class CancelAll:
    """Have the server cancel all of its goals, whoever sent them."""


@dataclass(frozen=True, kw_only=True)
class Unsent:
    """The command that was asked for cannot leave."""

    why: str


Event = Found | JointsSeen | Answered | Ended | CancelAnswered | Asked
Message = SendGoal | CancelAll | Unsent | Report


class Machine:
    """One arm behind one action. `step` takes what happened, and says what to do and to report."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """ValueError where that is anything but one arm."""
        if len(devices) != 1 or not isinstance(devices[0], Arm):
            raise ValueError("a joint trajectory controller moves one arm")
        self._arm = devices[0]
        self._settings = settings
        self._joints = settings.joint_names(self._arm)
        self._out: list[Message] = []
        self._servers: tuple[int, ...] = ()
        self._server: int | None = None  # the last one that was there alone
        self._alone_at = -math.inf  # when that was
        self._why = ""  # why there is no link, as it was reported
        self._q: tuple[float, ...] | None = None
        self._stamp: tuple[int, int] | None = None
        self._heard_at = -math.inf
        self._rest = Rest()
        self._goal: Goal | None = None
        self._homing: str | None = None
        self._cancel_at: float | None = None  # since when a cancel is not answered
        self._cancelled_at = -math.inf  # when the last one was
        self._stop_id = ""
        self._latched = False
        self._ids: dict[str, str] = {}
        self._news = False
        self._reported_at = -math.inf

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """What is to be done; at most one report of the arm, after all that happened."""
        for event in events:
            self._take(now, event)
        why = self._missing(now)
        if why:
            self._lose(now, why)
        else:
            self._pass_time(now)
            if self._news or now >= self._reported_at + REPORT_S:
                self._out.append(self._report(now))
        out, self._out = self._out, []
        return out

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, Asked):
            self._ask(now, event.command)
        elif isinstance(event, Found):
            self._find(now, event.servers)
        elif isinstance(event, JointsSeen):
            self._see(now, event)
        elif isinstance(event, Answered):
            self._hear_answer(now, event)
        elif isinstance(event, Ended):
            self._hear_end(now, event)
        else:
            self._hear_cancel(now, event)

    def _pass_time(self, now: float) -> None:
        goal = self._goal
        if self._cancel_at is not None and now >= self._cancel_at + ANSWER_S:
            self._cancel(now)
        if goal is None:
            return
        if not goal.accepted and not goal.stopped and now >= goal.sent_at + ANSWER_S:
            # It may still be accepted later, and is cancelled then.
            self._end(failed=goal.id, failure="goal_not_answered")
            self._cancel(now)
        elif goal.succeeded_at is not None:
            self._believe(now, goal, goal.succeeded_at)
        elif goal.stopped and self._cancel_at is None:
            # The server has cancelled all it has, and the arm rests: no result is waited for.
            since = self._cancelled_at + ANSWER_S
            if now >= since and self._rest.holds(now, self._cancelled_at):
                self._end()

    def _believe(self, now: float, goal: Goal, since: float) -> None:
        """A result is believed where joints that came after it are at the goal, or the arm rests elsewhere.

        The plant compares the joints in any case, and says that the goal was not reached.
        """
        assert self._q is not None
        if self._heard_at <= since:
            return
        if self._arm.stands_at(self._q, goal.q) or self._rest.holds(now, since):
            self._end(done=goal.id)

    # The link.

    def _missing(self, now: float) -> str:
        """Why the arm cannot be reached; "" where it can."""
        if now >= self._alone_at + GONE_S and not self._servers:
            return f"there is no action server {self._settings.action}"
        if now >= self._alone_at + GONE_S:
            return f"there are {len(self._servers)} action servers {self._settings.action}; one is needed"
        if now >= self._heard_at + SILENT_S:
            joints = ", ".join(self._joints)
            return f"{self._settings.joint_states} has said nothing new of {joints} for {SILENT_S:g} s"
        return ""

    def _find(self, now: float, servers: tuple[int, ...]) -> None:
        self._servers = servers
        if len(servers) != 1:
            return
        self._alone_at = now
        if servers[0] == self._server:
            return
        if self._server is not None:  # it was started anew, and knows of no goal
            self._forget()
        self._server, self._news = servers[0], True

    def _lose(self, now: float, why: str) -> None:
        """What is open is nobody's; a goal that the same server goes on with is cancelled once it is back."""
        if self._goal is not None:
            self._goal.stopped, self._goal.succeeded_at = True, None
            self._cancel_at = -math.inf  # at once, where it is back
        self._homing, self._stop_id = None, ""
        if why != self._why:
            self._why = why
            self._out.append(lost(self._arm.name, at=now, why=why))

    def _forget(self) -> None:
        self._goal = self._homing = self._cancel_at = None
        self._stop_id, self._ids = "", {}

    def _see(self, now: float, seen: JointsSeen) -> None:
        """A joint state that is not of this arm, is none, or comes again, is no news of it."""
        at = dict(zip(seen.names, seen.positions, strict=False))
        if len(seen.names) != len(seen.positions) or not all(name in at for name in self._joints):
            return
        q = tuple(at[name] for name in self._joints)
        if seen.stamp == self._stamp or not all(math.isfinite(value) for value in q):
            return
        self._news = self._news or self._q is None
        self._q, self._stamp, self._heard_at = q, seen.stamp, now
        self._rest.look(now, q)
        if self._homing is not None:
            self._tell(done=self._homing)
            self._homing = None

    # What it is told.

    def _ask(self, now: float, command: Command) -> None:
        why = self._missing(now)
        if why:
            self._out.append(Unsent(why=why))
        elif isinstance(command, Stop):
            self._ask_stop(now, command)
        elif self._goal is not None or self._homing is not None:
            self._reject(command.id, "busy")
        elif isinstance(command, MoveJoints):
            self._move(now, command)
        elif isinstance(command, Home):
            # Its encoders know where they are: all that is proven is that the arm is heard.
            self._homing = command.id
            self._tell(accepted=command.id)
        else:
            self._out.append(
                Unsent(why=f"a joint trajectory controller has no word for {type(command).__name__}")
            )

    def _move(self, now: float, command: MoveJoints) -> None:
        assert self._q is not None
        self._goal = Goal(id=command.id, q=command.q, sent_at=now)
        duration_s = self._settings.duration_s(self._arm, self._q, command.q)
        self._out.append(SendGoal(id=command.id, joints=self._joints, q=command.q, duration_s=duration_s))
        self._news = True

    def _ask_stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
        self._news = True
        if command.mode is StopMode.CLEAR:
            self._tell(accepted=command.id)
            return
        self._homing = None
        if self._goal is not None:
            self._goal.stopped, self._goal.succeeded_at = True, None
        self._stop_id = command.id
        self._cancel(now)

    def _cancel(self, now: float) -> None:
        self._cancel_at, self._news = now, True
        self._out.append(CancelAll())

    # What the server says.

    def _hear_answer(self, now: float, answer: Answered) -> None:
        goal = self._goal
        if goal is None or answer.id != goal.id:
            if answer.accepted:  # nobody waits for it any more
                self._cancel(now)
        elif not answer.accepted:
            self._end(**({} if goal.stopped else {"rejected": goal.id, "refusal": "goal_refused"}))
        else:
            goal.accepted = True
            if goal.stopped:  # the cancel may have come before it, and cannot have meant it then
                self._cancel(now)
            else:
                self._tell(accepted=goal.id)

    def _hear_end(self, now: float, end: Ended) -> None:
        goal = self._goal
        if goal is None or end.id != goal.id:
            return
        if goal.stopped:
            self._end()
        elif end.status is Status.SUCCEEDED and end.error == 0:
            goal.succeeded_at = now
        else:
            self._end(failed=goal.id, failure=_failure(end))

    def _hear_cancel(self, now: float, answer: CancelAnswered) -> None:
        if self._cancel_at is None:
            return
        if answer.refused and self._goal is not None:
            self._reject(self._stop_id, "cancel_refused")
            self._stop_id = ""
            return  # asked again once ANSWER_S have gone by
        self._cancel_at, self._cancelled_at = None, now
        self._tell(accepted=self._stop_id)
        self._stop_id = ""

    # What the plant hears.

    def _end(self, **ids: str) -> None:
        self._goal = None
        self._tell(**ids)

    def _tell(self, **ids: str) -> None:
        self._ids |= {name: id for name, id in ids.items() if id}
        self._news = True

    def _reject(self, id: str, word: str) -> None:
        if id:
            self._tell(rejected=id, refusal=word)

    def _state(self, now: float) -> MotionState:
        if self._goal is not None or self._cancel_at is not None or not self._rest.holds(now):
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if self._latched else MotionState.STOPPED

    def _report(self, now: float) -> Report:
        self._news, self._reported_at, self._why = False, now, ""
        said = Report(
            at=now,
            robot=self._arm.name,
            boot_id=self._server,
            state=self._state(now),
            homed=self._homing is None,
            q=self._q,
        )
        return said.again(now, **self._ids)


def _failure(end: Ended) -> str:
    """Why a goal failed, in a word; what the controller adds follows it."""
    if end.status is Status.CANCELED:
        word = "cancelled_by_another_client"
    elif end.status is Status.UNKNOWN:
        word = "goal_unknown_to_the_server"
    else:
        word = ERRORS.get(end.error, "aborted" if end.error == 0 else f"error {end.error}")
    return plain(f"{word} {end.text}".strip(), LONGEST_WORD)
