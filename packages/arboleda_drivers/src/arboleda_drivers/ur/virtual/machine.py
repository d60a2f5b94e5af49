"""Virtual controller of Universal Robots: dashboard, RTDE, programs and their arm. No sockets."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from arboleda_drivers.ur.arm_state import Mode, Runtime
from arboleda_drivers.ur.dashboard import GREETING
from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE
from arboleda_drivers.ur.primary import READ_ONLY, packed_code, packed_exception
from arboleda_drivers.ur.rtde import NotRtde
from arboleda_drivers.virtual.joint_path import Joints

from .arm import Arm
from .dashboard import Dashboard
from .faults import SEVERING
from .program_run import ProgramRun
from .rtde_session import RtdeSession, Values
from .script import Call, Program, ProgramReader, ScriptError

LATE_S, DROPPED_S = 1.0, 0.6
OTHER = "other"  # the program of somebody else
OTHER_RAD = math.radians(5)
LONGEST_LINE = 4096
LONGEST_S = 0.05  # between two looks at the faults
HALVED = ("protective_stop", "program_stopped", "other_program", "joint_limit", "brakes_stuck")


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
        self.arm = Arm(running=running)
        self.run = ProgramRun(self.arm, joints, faults)
        self._period_s = period_s
        self._now = -math.inf
        self._torn = False
        self._booted_at: float | None = None
        self._off = False
        self._severed: set[str] = set()
        self._out: list[Message] = []
        self._dashboard = Dashboard(self.arm)
        self._last: Values | None = None  # of the last frame
        self._forget_clients()

    @property
    def next_deadline(self) -> float:
        if self._off:
            return self._now + LONGEST_S
        frames = min((each.due_at for each in self._sessions.values()), default=math.inf)
        late = self._late[0][0] if self._late else math.inf
        arm = min(self.run.next_deadline, self.arm.next_deadline)
        return min(frames, late, arm, self._now + LONGEST_S)

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
            self.run.go_on(now)
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
        self.run.boot()
        self._last = None
        self._forget_clients()

    def _forget_clients(self) -> None:
        self._sessions: dict[int, RtdeSession] = {}
        self._readers: dict[int, ProgramReader] = {}
        self._lines: dict[int, bytes] = {}
        self._read_only: set[int] = set()
        self._late: deque[tuple[float, ToClient]] = deque()

    def _pass_time(self, now: float) -> None:
        self.arm.pass_time(now, self.faults)
        if self.arm.mode != Mode.RUNNING:
            self.run.break_off(now)
        if "local_control" in self.faults:
            if self.run.name:
                self.run.break_off(now)
            self._read_only |= set(self._readers)
        self.run.hold(now)
        self.run.travel(now)
        if self.run.drive.is_half_way(now) and self.run.name != OTHER:
            self._befall(now)

    def _befall(self, now: float) -> None:
        """Let the faults strike that befall an arm half way."""
        name = next((each for each in HALVED if each in self.faults), "")
        if name == "protective_stop":
            self.arm.protect(now)
            self.run.hold(now)
        elif name:
            self.run.break_off(now)
        if name == "brakes_stuck":
            self.arm.mode = Mode.IDLE
        if name == "joint_limit":
            self._tell_all(packed_exception(4, "joint limit"))
        if name == "other_program":
            goal = tuple(each + OTHER_RAD for each in self.run.drive.joints)
            move = Call(line=2, function="movej", values=(goal,), named={})
            self.run.begin(now, Program(name=OTHER, calls=(move,)))

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
        elif self.run.take(now, program) and program.moves and "hang_up" in self.faults:
            self.run.go_on(now)
            self._forget_clients()
            self._out.append(Disconnect())

    # What it shows.

    def values(self, now: float) -> Values:
        """The variables of RTDE, by name."""
        assert self._booted_at is not None
        safety, runtime = self.arm.safety, self.run.shown_runtime(now)
        powered, playing = self.arm.mode >= Mode.POWER_ON, self.run.runtime != Runtime.STOPPED
        return {
            "timestamp": now - self._booted_at,
            "target_q": self.run.drive.joints,
            "target_qd": (0.0,) * 6,
            "actual_q": (math.nan,) * 6 if "garbled" in self.faults else self.run.drive.joints,
            "actual_qd": (0.0,) * 6,
            "robot_mode": self.arm.mode,
            "safety_mode": safety,
            "safety_status": safety,
            "runtime_state": runtime,
            "robot_status_bits": powered | playing << 1,
            "safety_status_bits": 1 << (safety - 1),
            "speed_scaling": self.run.slider,
            "target_speed_fraction": self.run.slider,
            "actual_digital_output_bits": self.run.outputs,
            **{f"output_int_register_{each}": self.run.registers.get(each, 0) for each in range(48)},
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
        if "heartbeat_lost" not in self.faults:
            self.run.write(self._now, values)

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
        reply = self._dashboard.reply(now, line, self.run.runtime, is_local="local_control" in self.faults)
        if line == "stop" and reply == "Stopped":
            if "deaf" not in self.faults:
                self.run.drive.brake(now)
            self.run.end(now)
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
