"""Virtual controller of a Dobot: dashboard, queue of moves, feedback frames. No sockets, no clock."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from arboleda_drivers.dobot.frames import SIZE, TEST_AT, Feedback, Mode
from arboleda_drivers.virtual.joint_path import Joints, Path, between

FRAME_S = 0.008
SPEED_DEG_S = (150.0, 150.0, 180.0, 223.0, 223.0, 223.0)  # of a CR10A, as its maker publishes them
ACCELERATION_DEG_S2 = 180.0
ENABLE_S, POWER_S = 0.5, 1.0  # a real one takes some 10 s to be powered
LATE_S, LATE_START_S = 1.0, 0.2
SHORT_DEG = 2.0
BUTTON, NO_SOLUTION = 116, 17  # alarms
LINE = re.compile(r"\s*(\w+)\s*\((.*)\)\s*", re.DOTALL)
JOINTS = re.compile(r"joint=\{([^}]*)\}(.*)")
UNKNOWN, WRONG_COUNT, WRONG_TYPE, OUT_OF_RANGE = -10000, -20000, -30001, -40001
OTHER_MODE = "Control Mode Is Not Tcp"
BUTTON_LINE = "emergency" + "stop"  # the maker's name of the robot's own button, which nothing of ours has
QUERIES = ("robotmode", "getangle", "geterrorid", "getcurrentcommandid", "gettooldo")


@dataclass(frozen=True, kw_only=True)
class ClientText:
    """Event: a client sent the dashboard this; one line, or several that each end with a bracket."""

    client: int
    text: str


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Line to one client of the dashboard."""

    client: int
    text: str


@dataclass(frozen=True, kw_only=True)
class Frame:
    """Frame to every client of the feedback port."""

    data: bytes


@dataclass(frozen=True, kw_only=True)
class Disconnect:
    """Message: end every connection."""


Message = Answer | Frame | Disconnect


@dataclass(frozen=True, kw_only=True)
class QueuedMove:
    """Move that waits for its turn."""

    number: int
    goal: Joints
    speed_percent: float = 100.0
    acceleration_percent: float = 100.0


class ErrorReply(Exception):
    """Error: the controller replies with an ErrorID other than 0."""

    def __init__(self, error: int) -> None:
        super().__init__(error)
        self.error = error


class VirtualDobot:
    """Virtual arm with its controller; `faults` are looked up when they matter. Times in s of any clock."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        joints_deg: Joints = (0.0,) * 6,
        enabled: bool = False,
        unix_s: float = 0.0,
        frame_s: float = FRAME_S,
    ) -> None:
        self.faults = faults
        self.joints_deg = joints_deg
        self.outputs = 0  # of the tool, a bit each
        self.speed_percent = 100.0
        self._unix_s = unix_s  # Unix time at which `now` is 0
        self._frame_s = frame_s
        self._powered = True
        self._enabled_at = -math.inf if enabled else math.inf
        self._powered_at = math.inf
        self._booted_at: float | None = None
        self._off = False
        self._now = -math.inf
        self._frame_at = -math.inf
        self._frames = 0
        self._late: deque[tuple[float, Answer]] = deque()
        self._last: Feedback | None = None
        self._forget()

    @property
    def next_deadline(self) -> float:
        late = self._late[0][0] if self._late else math.inf
        return min(self._frame_at, late, self._path.ends_at if self._path else math.inf)

    @property
    def is_off(self) -> bool:
        """True while nobody can connect."""
        return "power_cycle" in self.faults

    def step(self, now: float, events: Sequence[ClientText]) -> list[Message]:
        """Let time pass, take events, and return messages."""
        out: list[Message] = []
        self._now = now
        self._booted_at = now if self._booted_at is None else self._booted_at
        if self.is_off or self._off:
            if self.is_off:
                self._off = True
                self._frame_at = now + self._frame_s
                return [Disconnect()]
            self._boot(now)
        self._pass_time(now)
        for event in events:
            for line in _lines(event.text):
                out += self._answer(now, event.client, line)
        while self._late and self._late[0][0] <= now:
            out.append(self._late.popleft()[1])
        if self._frame_at <= now:
            self._frame_at = now + self._frame_s
            out += self._frame(now)
        return out

    @property
    def mode(self) -> Mode:
        if self._alarms:
            return Mode.ERROR
        if self._collided:
            return Mode.COLLISION
        if not self._powered:
            return Mode.POWER_OFF
        if not self._enabled:
            return Mode.DISABLED
        if self._paused:
            return Mode.PAUSED
        moves = self._path.began_at <= self._now if self._path is not None else bool(self._queue)
        return Mode.RUNNING if moves or "script" in self.faults else Mode.IDLE

    # How time passes.

    def _forget(self) -> None:
        self._queue: deque[QueuedMove] = deque()
        self._path: Path | None = None
        self._command = 0  # the number of the last move that began
        self._number = 0
        self._alarms: set[int] = set()
        self._collided = self._paused = self._enabled = False

    def _boot(self, now: float) -> None:
        self._forget()
        self._off, self._booted_at, self._last = False, now, None
        self._enabled_at, self.outputs = math.inf, 0
        self._late.clear()

    def _pass_time(self, now: float) -> None:
        self._powered = self._powered or self._powered_at <= now
        self._befall(now)
        self._enabled = self._enabled_at <= now
        self._travel(now)
        while self._path is None and self._queue and self.mode is Mode.RUNNING:
            self._begin(now, self._queue.popleft())
            self._travel(now)

    def _befall(self, now: float) -> None:
        """Let the faults strike that befall an arm by themselves."""
        if "power_off" in self.faults:
            self._powered, self._powered_at = False, math.inf
            self._halt(now, disable=True)
        if "stop_button" in self.faults:
            self._alarms.add(BUTTON)
            self._halt(now, disable=True)
        if self._path is None or self._part(now) < 0.5 or self._path.braked_s < math.inf:
            return
        if "collision" in self.faults:
            self._collided = True
            self._halt(now)
        if "alarm" in self.faults:
            self._alarms.add(NO_SOLUTION)
            self._halt(now)
        if "second_client" in self.faults:
            self._number += 1
            self._path = None
            self._begin(
                now, QueuedMove(number=self._number, goal=tuple(each + 5 for each in self.joints_deg))
            )

    def _part(self, now: float) -> float:
        assert self._path is not None
        whole_s = self._path.ends_at - self._path.began_at
        return 1.0 if whole_s <= 0 else (now - self._path.began_at) / whole_s

    def _travel(self, now: float) -> None:
        if self._path is None:
            return
        if "stall" in self.faults and self._part(now) >= 0.5:
            return
        self.joints_deg = self._path.at(now)
        if self._path.ends_at <= now:
            self._path = None

    def _begin(self, now: float, queued: QueuedMove) -> None:
        self._command = queued.number
        if "lie" in self.faults:
            return
        goal = queued.goal
        if "short" in self.faults:
            goal = (goal[0] - math.copysign(SHORT_DEG, goal[0] - self.joints_deg[0]), *goal[1:])
        speed = queued.speed_percent * self.speed_percent / 100 * (0.1 if "slow" in self.faults else 1.0)
        begins_at = now + LATE_START_S if "late_start" in self.faults else now
        self._path = _path(self.joints_deg, goal, begins_at, speed, queued.acceleration_percent)

    def _halt(self, now: float, *, disable: bool = False) -> None:
        self._queue.clear()
        self._paused = False
        if self._path is not None:
            self._path = self._path.braked(now)
        if disable:
            self._enabled_at = math.inf

    # Commands.

    def _answer(self, now: float, client: int, line: str) -> list[Message]:
        text, hang_up = self._reply(now, line)
        answer = Answer(client=client, text=text)
        if hang_up:
            return [Disconnect()]
        if "no_replies" in self.faults:
            return []
        if "nonsense_replies" in self.faults:
            return [replace(answer, text="0,{oops;")]
        if "late_replies" in self.faults:
            self._late.append((now + LATE_S, answer))
            return []
        return [answer]

    def _reply(self, now: float, line: str) -> tuple[str, bool]:
        """The reply to a line, and True if the connections end with it."""
        found = LINE.fullmatch(line)
        if found is None:
            return f"{UNKNOWN},{{}},{line.strip()[:40]};", False
        name = found[1].lower()
        if "not_tcp" in self.faults and name not in QUERIES:
            return OTHER_MODE, False
        try:
            does = getattr(self, f"_do_{'button' if name == BUTTON_LINE else name}", None)
            if does is None:
                raise ErrorReply(UNKNOWN)
            value = does(now, found[2])
            error = 0
        except ErrorReply as refused:
            value, error = "", refused.error
        if name == "geterrorid" and "no_brace" in self.faults:
            return f"{error},{{{value},GetErrorId();", False
        hangs_up = name == "movj" and error == 0 and "hang_up" in self.faults
        return f"{error},{{{value}}},{found[1]}({found[2]});", hangs_up

    def _do_requestcontrol(self, now: float, values: str) -> str:
        if self.mode not in (Mode.POWER_OFF, Mode.DISABLED):
            raise ErrorReply(-1)
        return ""

    def _do_poweron(self, now: float, values: str) -> str:
        if not self._powered and "power_off" not in self.faults:
            self._powered_at = now + POWER_S
        return ""

    def _do_enablerobot(self, now: float, values: str) -> str:
        self._check(power=True)
        if not self._enabled:
            self._enabled_at = now + ENABLE_S
        return ""

    def _do_disablerobot(self, now: float, values: str) -> str:
        self._halt(now, disable=True)
        return ""

    def _do_clearerror(self, now: float, values: str) -> str:
        self._alarms.clear()
        self._collided = False
        self._befall(now)
        return ""

    def _do_button(self, now: float, values: str) -> str:
        if values.strip() == "1":
            self._alarms.add(BUTTON)
            self._halt(now, disable=True)
        return ""

    def _do_stop(self, now: float, values: str) -> str:
        if "deaf" not in self.faults:
            self._halt(now)
        return ""

    def _do_pause(self, now: float, values: str) -> str:
        if self._path is None:
            raise ErrorReply(-1)
        if not self._paused:
            self._resumes = QueuedMove(number=self._command, goal=self._path.goal)
            self._path, self._paused = self._path.braked(now), True
        return ""

    def _do_continue(self, now: float, values: str) -> str:
        if not self._paused:
            raise ErrorReply(-1)
        self._queue.appendleft(self._resumes)
        self._paused = False
        return ""

    def _do_speedfactor(self, now: float, values: str) -> str:
        (ratio,) = _numbers(values, 1)
        if not 1 <= ratio <= 100:
            raise ErrorReply(OUT_OF_RANGE)
        self.speed_percent = ratio
        return ""

    def _do_robotmode(self, now: float, values: str) -> str:
        return str(int(self.mode))

    def _do_getangle(self, now: float, values: str) -> str:
        return ",".join(f"{each:.6f}" for each in self.joints_deg)

    def _do_geterrorid(self, now: float, values: str) -> str:
        alarms = ",".join(str(each) for each in sorted(self._alarms))
        return f"[[{alarms}],[],[],[],[],[],[]]"

    def _do_getcurrentcommandid(self, now: float, values: str) -> str:
        return str(self._command)

    def _do_movj(self, now: float, values: str) -> str:
        self._check(power=True, moves=True)
        found = JOINTS.fullmatch(values.strip())
        if found is None:  # poses need the arm's kinematics, which are not played here
            raise ErrorReply(WRONG_TYPE)
        goal = _numbers(found[1], 6)
        options = dict(re.findall(r"(\w+)=([\d.]+)", found[2]))
        before, self._number = self._number, self._number + 1
        queued = QueuedMove(
            number=self._number,
            goal=goal,
            speed_percent=float(options.get("v", 100)),
            acceleration_percent=float(options.get("a", 100)),
        )
        self._queue.append(queued)
        return str(before if "wrong_number" in self.faults else self._number)

    def _do_tooldoinstant(self, now: float, values: str) -> str:
        self._check(power=True)
        index, on = _numbers(values, 2)
        bit = self._bit(index)
        if "stuck_output" not in self.faults:
            self.outputs = self.outputs | bit if on else self.outputs & ~bit
        return ""

    def _do_gettooldo(self, now: float, values: str) -> str:
        self._check(power=True)
        if "script" in self.faults:
            raise ErrorReply(-5)
        (index,) = _numbers(values, 1)
        return "1" if self.outputs & self._bit(index) else "0"

    def _bit(self, index: float) -> int:
        if index not in (1, 2, 3, 4):
            raise ErrorReply(OUT_OF_RANGE)
        return 1 << (int(index) - 1)

    def _check(self, *, power: bool = False, moves: bool = False) -> None:
        """Raises ErrorReply if a command is impossible in this state."""
        if "stop_button" in self.faults:
            raise ErrorReply(-3)
        if self._alarms or self._collided:
            raise ErrorReply(-2)
        if power and not self._powered:
            raise ErrorReply(-4)
        if moves and "script" in self.faults:
            raise ErrorReply(-5)
        if moves and ("refuse" in self.faults or not self._enabled or self._paused):
            raise ErrorReply(-1)

    # Feedback, sent without a request.

    def _frame(self, now: float) -> list[Message]:
        self._frames += 1
        if "mute" in self.faults:
            return []
        if "frozen" not in self.faults or self._last is None:
            self._last = self._feedback(now)
        data = self._last.packed()
        if "garbled" in self.faults:
            data = data[:TEST_AT] + bytes(8) + data[TEST_AT + 8 :]
        if "torn" in self.faults and self._frames % 2:
            data = data[: SIZE - 100]
        return [Frame(data=data)]

    def _feedback(self, now: float) -> Feedback:
        assert self._booted_at is not None
        return Feedback(
            mode=self.mode,
            command=self._command,
            joints_deg=self.joints_deg,
            time_ms=int((self._unix_s + now) * 1000),
            run_ms=int((now - self._booted_at) * 1000),
        )


def _lines(text: str) -> list[str]:
    """The commands in a text of several."""
    found = re.findall(r"[^()]*\([^()]*\)", text)
    return found or [text]


def _numbers(text: str, count: int) -> Joints:
    parts = text.split(",")
    if len(parts) != count:
        raise ErrorReply(WRONG_COUNT)
    try:
        numbers = tuple(float(part) for part in parts)
    except ValueError as error:
        raise ErrorReply(WRONG_TYPE) from error
    if not all(map(math.isfinite, numbers)):
        raise ErrorReply(WRONG_TYPE)
    return numbers


def _path(start: Joints, goal: Joints, now: float, speed_percent: float, acceleration_percent: float) -> Path:
    """The path of a joint move that begins now."""
    distances = [abs(b - a) for a, b in zip(start, goal, strict=True)]
    times = [distance / speed for distance, speed in zip(distances, SPEED_DEG_S, strict=True)]
    slowest = times.index(max(times))
    return between(
        start,
        goal,
        now,
        speed=SPEED_DEG_S[slowest] * speed_percent / 100,
        acceleration=ACCELERATION_DEG_S2 * acceleration_percent / 100,
        leading=slowest,
    )
