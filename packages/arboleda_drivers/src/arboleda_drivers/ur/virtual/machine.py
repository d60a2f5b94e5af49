"""Virtual controller of Universal Robots: dashboard, RTDE, programs and their arm. No sockets."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from arboleda_drivers.ur.arm_state import NORMAL, Mode, Runtime
from arboleda_drivers.ur.dashboard import GREETING
from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE
from arboleda_drivers.ur.primary import READ_ONLY, packed_code, packed_exception
from arboleda_drivers.ur.rtde import NotRtde
from arboleda_drivers.virtual.joint_path import Joints, Path, between

from .arm import Arm
from .dashboard import Dashboard
from .faults import SEVERING
from .rtde_session import RtdeSession, Values
from .script import Call, Program, ProgramReader, ScriptError

LATE_S, LATE_START_S, LATE_RUNTIME_S, DROPPED_S = 1.0, 0.3, 0.1, 0.6
SLIDER = 0.03
OTHER = "other"  # the program of somebody else
OTHER_RAD = math.radians(5)
SHORT_RAD = math.radians(2)
LONGEST_LINE = 4096
LONGEST_S = 0.05  # between two looks at the faults
HALVED = ("protective_stop", "program_stopped", "other_program", "joint_limit", "brakes_stuck")
OUTPUTS_AT = {"standard": 0, "configurable": 8, "tool": 16}  # the bits of the outputs of each sort


@dataclass(frozen=True, kw_only=True)
class Joined:
    """Event: a client has connected to this port."""

    client: int
    port: str


@dataclass(frozen=True, kw_only=True)
class ClientData:
    """Event: bytes of a client; none: it has hung up."""

    client: int
    port: str
    data: bytes


@dataclass(frozen=True, kw_only=True)
class ToClient:
    """Message: bytes to one client."""

    client: int
    data: bytes


@dataclass(frozen=True, kw_only=True)
class Drop:
    """Message: end the connection of one client."""

    client: int


@dataclass(frozen=True, kw_only=True)
class Disconnect:
    """Message: end every connection."""


Event = Joined | ClientData
Message = ToClient | Drop | Disconnect


class VirtualUr:
    """Virtual arm with its controller; `faults` are looked up when they matter. Times in s of any clock."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        joints: Joints = (0.0,) * 6,
        running: bool = False,
        period_s: float | None = None,
    ) -> None:
        self.faults = faults
        self.joints = joints
        self.arm = Arm(running=running)
        self._period_s = period_s
        self._now = -math.inf
        self._torn = False
        self._booted_at: float | None = None
        self._off = False
        self._severed: set[str] = set()
        self._out: list[Message] = []
        self._dashboard = Dashboard(self.arm)
        self._forget_clients()
        self._forget_program()
        self._registers: dict[int, int] = {}
        self.outputs = 0
        self.slider = 1.0

    @property
    def next_deadline(self) -> float:
        if self._off:
            return self._now + LONGEST_S
        frames = min((each.due_at for each in self._sessions.values()), default=math.inf)
        late = self._late[0][0] if self._late else math.inf
        moves = self._path.ends_at if self._path else math.inf
        waits = min(self._waits_until, self._starts[0][0] if self._starts else math.inf)
        return min(frames, late, moves, waits, self._watch_at, self.arm.next_deadline, self._now + LONGEST_S)

    @property
    def is_off(self) -> bool:
        """True while nobody can connect."""
        return "reboot" in self.faults or "connections_full" in self.faults

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Let time pass, take events, and return messages."""
        self._now = now
        self._booted_at = now if self._booted_at is None else self._booted_at
        self._sever()
        if "reboot" in self.faults:
            self._off = True
        else:
            if self._off:
                self._boot(now)
            self._pass_time(now)
            for event in events:
                self._take(now, event)
            self._run(now)
            self._send_frames(now)
            while self._late and self._late[0][0] <= now:
                self._out.append(self._late.popleft()[1])
        out, self._out = self._out, []
        return out

    # What befalls it.

    def _sever(self) -> None:
        for name in SEVERING:
            if name not in self.faults:
                self._severed.discard(name)
            elif name not in self._severed:
                self._severed.add(name)
                self._forget_clients()
                self._out.append(Disconnect())

    def _boot(self, now: float) -> None:
        self._off, self._booted_at = False, now
        self.arm.boot()
        self._registers, self.outputs = {}, 0
        self._forget_program()
        self._forget_clients()

    def _forget_clients(self) -> None:
        self._sessions: dict[int, RtdeSession] = {}
        self._readers: dict[int, ProgramReader] = {}
        self._lines: dict[int, bytes] = {}
        self._read_only: set[int] = set()
        self._late: deque[tuple[float, ToClient]] = deque()

    def _forget_program(self) -> None:
        self._calls: deque[Call] = deque()
        self._program = ""  # the name of the one that runs
        self._path: Path | None = None
        self._resumes: Joints | None = None  # the goal of a paused move
        self._starts: deque[tuple[float, Program]] = deque()
        self._waits_until = math.inf
        self._waits_for_path = False
        self._watch: tuple[str, float] | None = None
        self._watch_at = math.inf
        self._shown: deque[tuple[float, Runtime]] = deque()
        self._last: Values | None = None

    def _pass_time(self, now: float) -> None:
        self.slider = SLIDER if "slider" in self.faults else 1.0
        self.arm.pass_time(now, self.faults)
        if self.arm.mode != Mode.RUNNING:
            self._brake(now)
            self._end_program()
        if "local_control" in self.faults:
            if self._program:
                self._brake(now)
                self._end_program()
            self._read_only |= set(self._readers)
        if self.arm.safety != NORMAL:
            self._pause(now)
        elif self._resumes is not None and self.arm.goes_on:
            self._resume(now)
        self._travel(now)
        runs_ours = self._path is not None and self._path.braked_s == math.inf and self._program != OTHER
        if runs_ours and self._part(now) >= 0.5:
            self._befall(now)

    def _befall(self, now: float) -> None:
        """Let the faults strike that befall an arm half way."""
        name = next((each for each in HALVED if each in self.faults), "")
        if name == "protective_stop":
            self.arm.protect(now)
            self._pause(now)
        elif name:
            self._brake(now)
            self._end_program()
        if name == "brakes_stuck":
            self.arm.mode = Mode.IDLE
        if name == "joint_limit":
            self._tell_all(packed_exception(4, "joint limit"))
        if name == "other_program":
            goal = tuple(each + OTHER_RAD for each in self.joints)
            move = Call(line=2, function="movej", values=(goal,), named={})
            self._begin(now, Program(name=OTHER, calls=(move,)))

    # Programs.

    def _take_programs(self, now: float, client: int, data: bytes) -> None:
        try:
            for program in self._readers[client].feed(data):
                self._take_program(now, client, program)
        except ScriptError as error:
            self._tell(client, packed_exception(error.line, error.text))

    def _take_program(self, now: float, client: int, program: Program) -> None:
        if client in self._read_only:
            self._tell(client, packed_code(READ_ONLY, "interface is read-only"))
        elif "refuse" in self.faults:
            self._tell(client, packed_exception(1, "refused"))
        elif program.is_secondary:
            for call in program.calls:
                self._do(now, call)
        elif self.arm.mode != Mode.RUNNING or self.arm.safety != NORMAL:
            return
        elif "not_begun" not in self.faults and not self.arm.popup:
            late_s = LATE_START_S if "late_start" in self.faults else 0.0
            self._starts.append((now + late_s, program))
            moves = any(call.function == "movej" for call in program.calls)
            if moves and "hang_up" in self.faults:
                self._run(now)
                self._forget_clients()
                self._out.append(Disconnect())

    def _run(self, now: float) -> None:
        while self._starts and self._starts[0][0] <= now:
            self._begin(now, self._starts.popleft()[1])
        if self._watch is not None and self._watch_at <= now:
            self._brake(now)
            self._end_program()
        if self.runtime == Runtime.PAUSED:
            return
        self._travel(now)
        if self._waits_until <= now:
            self._waits_until = math.inf
        while self._calls and not self._is_blocked:
            self._do(now, self._calls.popleft())
        if self._program and not self._calls and not self._is_blocked:
            self._end_program()

    @property
    def _is_blocked(self) -> bool:
        """True while the program waits: for time to pass, or for a motion that it has to wait for."""
        next_moves = bool(self._calls) and self._calls[0].function == "movej"
        waits = self._path is not None and (self._waits_for_path or next_moves)
        return waits or self._waits_until < math.inf

    def _begin(self, now: float, program: Program) -> None:
        """Let a program take the place of the one that runs."""
        if not ("deaf" in self.faults and "stop" in program.name):
            self._brake(now)
        self._end_program()
        self._program, self._calls = program.name, deque(program.calls)
        self._note_runtime(now)

    def _end_program(self) -> None:
        self._calls.clear()
        self._program, self._resumes = "", None
        self._watch, self._watch_at, self._waits_until = None, math.inf, math.inf
        self._note_runtime(self._now)

    def _do(self, now: float, call: Call) -> None:
        name, values = call.function, call.values
        self._waits_for_path = name in ("movej", "stopj")
        if name == "movej":
            self._move(now, tuple(values[0]), call.named)
        elif name == "stopj" and "deaf" not in self.faults:
            self._brake(now)
        elif name == "sleep":
            self._waits_until = now + values[0]
        elif name == "rtde_set_watchdog":
            self._watch, self._watch_at = (values[0], 1 / values[1]), now + 1 / values[1]
        elif name == "write_output_integer_register":
            if "echo_lost" not in self.faults:
                self._registers[values[0]] = values[1] - ("wrong_number" in self.faults)
        elif name.startswith("set_"):
            self._switch(OUTPUTS_AT[name.split("_")[1]] + values[0], on=values[1])

    def _switch(self, bit: int, *, on: bool) -> None:
        if "stuck_output" not in self.faults:
            self.outputs = self.outputs & ~(1 << bit) | (on << bit)

    # Motion.

    def _move(self, now: float, goal: Joints, named: dict[str, float]) -> None:
        if "lie" in self.faults:
            return
        if "short" in self.faults:
            goal = (goal[0] - math.copysign(SHORT_RAD, goal[0] - self.joints[0]), *goal[1:])
        ways = [abs(b - a) for a, b in zip(self.joints, goal, strict=True)]
        share = self.slider * (0.1 if "slow" in self.faults else 1.0)
        self._path = between(
            self.joints,
            goal,
            now,
            speed=named.get("v", 1.05) * share,
            acceleration=named.get("a", 1.4),
            leading=ways.index(max(ways)),
        )

    def _travel(self, now: float) -> None:
        if self._path is None or ("stall" in self.faults and self._part(now) >= 0.5):
            return
        self.joints = self._path.at(now)
        if self._path.ends_at <= now:
            self._path = None
            self._note_runtime(now)

    def _part(self, now: float) -> float:
        assert self._path is not None
        whole_s = self._path.ends_at - self._path.began_at
        return 1.0 if whole_s <= 0 else (now - self._path.began_at) / whole_s

    def _brake(self, now: float) -> None:
        if self._path is not None:
            self._path = self._path.braked(now)

    def _pause(self, now: float) -> None:
        if self._path is not None and self._path.braked_s == math.inf and self._program:
            self._resumes = self._path.goal
        self._brake(now)
        self._note_runtime(now)

    def _resume(self, now: float) -> None:
        assert self._resumes is not None
        goal, self._resumes = self._resumes, None
        self._move(now, goal, {})
        self._note_runtime(now)

    # What it shows.

    @property
    def runtime(self) -> Runtime:
        """The state of its program."""
        if self._resumes is not None or (self._program and self.arm.safety != NORMAL):
            return Runtime.PAUSED
        if self._program:
            return Runtime.PLAYING
        return Runtime.STOPPED if self._path is None else Runtime.STOPPING

    def _note_runtime(self, now: float) -> None:
        if not self._shown or self._shown[-1][1] != self.runtime:
            self._shown.append((now, self.runtime))
        while len(self._shown) > 2 and self._shown[1][0] <= now - LATE_RUNTIME_S:
            self._shown.popleft()

    def _shown_runtime(self, now: float) -> Runtime:
        self._note_runtime(now)
        if "late_runtime" not in self.faults:
            return self.runtime
        old = [state for at, state in self._shown if at <= now - LATE_RUNTIME_S]
        return old[-1] if old else self._shown[0][1]

    def values(self, now: float) -> Values:
        """The variables of RTDE, by name."""
        assert self._booted_at is not None
        safety, runtime = self.arm.safety, self._shown_runtime(now)
        powered, playing = self.arm.mode >= Mode.POWER_ON, self.runtime != Runtime.STOPPED
        return {
            "timestamp": now - self._booted_at,
            "target_q": self.joints,
            "target_qd": (0.0,) * 6,
            "actual_q": (math.nan,) * 6 if "garbled" in self.faults else self.joints,
            "actual_qd": (0.0,) * 6,
            "robot_mode": self.arm.mode,
            "safety_mode": safety,
            "safety_status": safety,
            "runtime_state": runtime,
            "robot_status_bits": powered | playing << 1,
            "safety_status_bits": 1 << (safety - 1),
            "speed_scaling": self.slider,
            "target_speed_fraction": self.slider,
            "actual_digital_output_bits": self.outputs,
            **{f"output_int_register_{each}": self._registers.get(each, 0) for each in range(48)},
        }

    def _send_frames(self, now: float) -> None:
        due = [(client, each) for client, each in self._sessions.items() if each.due_at <= now]
        if not due:
            return
        if self._last is None or "frozen" not in self.faults:
            self._last = self.values(now)
        for client, session in due:
            period_s = DROPPED_S if "rate_drops" in self.faults else self._period_s
            data = session.frame(now, self._last, period_s=period_s)
            if "mute" in self.faults:
                continue
            self._torn = not self._torn
            self._tell(client, data[:-20] if "torn" in self.faults and self._torn else data)

    def write(self, values: Values) -> None:
        """Take inputs of a client of RTDE."""
        if "heartbeat_lost" in self.faults:
            return
        if self._watch is not None and self._watch[0] in values:
            self._watch_at = self._now + self._watch[1]
        for sort in ("standard", "configurable"):
            mask, bits = (values.get(f"{sort}_digital_output{each}") for each in ("_mask", ""))
            for bit in range(8):
                if mask is not None and bits is not None and mask >> bit & 1:
                    self._switch(OUTPUTS_AT[sort] + bit, on=bool(bits >> bit & 1))

    # Clients.

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, Joined):
            self._join(event)
        elif not event.data:
            self._sessions.pop(event.client, None)
            self._readers.pop(event.client, None)
            self._lines.pop(event.client, None)
        elif event.port == DASHBOARD and event.client in self._lines:
            *lines, rest = (self._lines[event.client] + event.data).split(b"\n")
            self._lines[event.client] = rest[-LONGEST_LINE:]
            for line in lines:
                self._answer(now, event.client, line.decode("utf-8", "replace").strip())
        elif event.port == RTDE and event.client in self._sessions:
            self._exchange(now, event)
        elif event.port == PRIMARY and event.client in self._readers:
            self._take_programs(now, event.client, event.data)

    def _join(self, event: Joined) -> None:
        if event.port == DASHBOARD:
            self._lines[event.client] = b""
            self._tell(event.client, f"Connected: {GREETING}\n".encode())
        elif event.port == RTDE:
            self._sessions[event.client] = RtdeSession(self.write)
        else:
            self._readers[event.client] = ProgramReader()

    def _exchange(self, now: float, event: ClientData) -> None:
        session = self._sessions[event.client]
        is_old, in_use = "old_rtde" in self.faults, "in_use" in self.faults
        try:
            answer = session.hear(now, event.data, is_old=is_old, in_use=in_use)
        except NotRtde:
            del self._sessions[event.client]
            self._out.append(Drop(client=event.client))
            return
        if answer:
            self._tell(event.client, answer)

    def _answer(self, now: float, client: int, line: str) -> None:
        reply = self._dashboard.reply(now, line, self.runtime, is_local="local_control" in self.faults)
        if line == "stop" and reply == "Stopped":
            if "deaf" not in self.faults:
                self._brake(now)
            self._end_program()
        if "dashboard_mute" in self.faults:
            return
        more = "What?\n" if "unasked_replies" in self.faults else ""
        message = ToClient(client=client, data=f"{reply}\n{more}".encode())
        if "late_replies" in self.faults:
            self._late.append((now + LATE_S, message))
        else:
            self._out.append(message)

    def _tell(self, client: int, data: bytes) -> None:
        self._out.append(ToClient(client=client, data=data))

    def _tell_all(self, data: bytes) -> None:
        for client in self._readers:
            self._tell(client, data)
