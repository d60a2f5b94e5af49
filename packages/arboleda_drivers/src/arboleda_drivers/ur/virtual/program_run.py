"""Programs of a virtual controller: what runs, what it has to wait for, and what it does to the arm."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Mapping

from arboleda_drivers.ur.arm_state import NORMAL, Mode, Runtime
from arboleda_drivers.virtual.joint_path import Drive, Joints, between

from .arm import Arm
from .rtde_session import Values
from .script import Call, Program

LATE_START_S, LATE_RUNTIME_S = 0.3, 0.1
SLIDER = 0.03
SHORT_RAD = math.radians(2)
OUTPUTS_AT = {"standard": 0, "configurable": 8, "tool": 16}  # the bits of the outputs of each sort


class ProgramRun:
    """Run of one program after the other; `registers` and `outputs` are what they have written."""

    def __init__(self, arm: Arm, joints: Joints, faults: Collection[str]) -> None:
        self.drive = Drive(joints, faults)
        self._arm, self._faults = arm, faults
        self.boot()

    def boot(self) -> None:
        self.drive.path = None
        self.registers: dict[int, int] = {}
        self.outputs = 0
        self.name = ""  # of the program that runs
        self._calls: deque[Call] = deque()
        self._resumes: Joints | None = None  # the goal of a paused move
        self._starts: deque[tuple[float, Program]] = deque()
        self._waits_until = math.inf
        self._waits_for_path = False
        self._watch: tuple[str, float] | None = None
        self._watch_at = math.inf
        self._shown: deque[tuple[float, Runtime]] = deque()

    @property
    def next_deadline(self) -> float:
        starts_at = self._starts[0][0] if self._starts else math.inf
        return min(self.drive.next_deadline, self._waits_until, starts_at, self._watch_at)

    @property
    def slider(self) -> float:
        return SLIDER if "slider" in self._faults else 1.0

    # What runs.

    def take(self, now: float, program: Program) -> bool:
        """Take a program that a client has sent; True where it is to begin."""
        if program.is_secondary:
            for call in program.calls:
                self._do(now, call)
            return False
        can_move = self._arm.mode == Mode.RUNNING and self._arm.safety == NORMAL
        if not can_move or "not_begun" in self._faults or self._arm.popup:
            return False
        late_s = LATE_START_S if "late_start" in self._faults else 0.0
        self._starts.append((now + late_s, program))
        return True

    def go_on(self, now: float) -> None:
        """Do what is due."""
        while self._starts and self._starts[0][0] <= now:
            self.begin(now, self._starts.popleft()[1])
        if self._watch is not None and self._watch_at <= now:
            self.break_off(now)
        if self.runtime == Runtime.PAUSED:
            return
        self.travel(now)
        if self._waits_until <= now:
            self._waits_until = math.inf
        while self._calls and not self._is_blocked:
            self._do(now, self._calls.popleft())
        if self.name and not self._calls and not self._is_blocked:
            self.end(now)

    @property
    def _is_blocked(self) -> bool:
        """True while the program waits: for time to pass, or for a motion that it has to wait for."""
        next_moves = bool(self._calls) and self._calls[0].function == "movej"
        waits = self.drive.path is not None and (self._waits_for_path or next_moves)
        return waits or self._waits_until < math.inf

    def begin(self, now: float, program: Program) -> None:
        """Let a program take the place of the one that runs."""
        if not ("deaf" in self._faults and "stop" in program.name):
            self.drive.brake(now)
        self.end(now)
        self.name, self._calls = program.name, deque(program.calls)
        self._note_runtime(now)

    def end(self, now: float) -> None:
        self._calls.clear()
        self.name, self._resumes = "", None
        self._watch, self._watch_at, self._waits_until = None, math.inf, math.inf
        self._note_runtime(now)

    def break_off(self, now: float) -> None:
        self.drive.brake(now)
        self.end(now)

    def hold(self, now: float) -> None:
        """Pause the program, or go on with it, as the safety of the arm demands."""
        path = self.drive.path
        if self._arm.safety != NORMAL:
            if path is not None and path.braked_s == math.inf and self.name:
                self._resumes = path.goal
            self.drive.brake(now)
            self._note_runtime(now)
        elif self._resumes is not None and self._arm.goes_on:
            goal, self._resumes = self._resumes, None
            self._move(now, goal, {})
            self._note_runtime(now)

    # What it does.

    def _do(self, now: float, call: Call) -> None:
        name, values = call.function, call.values
        self._waits_for_path = name in ("movej", "stopj")
        if name == "movej":
            self._move(now, tuple(values[0]), call.named)
        elif name == "stopj" and "deaf" not in self._faults:
            self.drive.brake(now)
        elif name == "sleep":
            self._waits_until = now + values[0]
        elif name == "rtde_set_watchdog":
            self._watch, self._watch_at = (values[0], 1 / values[1]), now + 1 / values[1]
        elif name == "write_output_integer_register":
            if "echo_lost" not in self._faults:
                self.registers[values[0]] = values[1] - ("wrong_number" in self._faults)
        elif name.startswith("set_"):
            self._switch(OUTPUTS_AT[name.split("_")[1]] + values[0], on=values[1])

    def write(self, now: float, values: Values) -> None:
        """Take inputs of a client of RTDE: the sign of life of the program's watch, and outputs."""
        if self._watch is not None and self._watch[0] in values:
            self._watch_at = now + self._watch[1]
        for sort in ("standard", "configurable"):
            mask, bits = (values.get(f"{sort}_digital_output{each}") for each in ("_mask", ""))
            for bit in range(8):
                if mask is not None and bits is not None and mask >> bit & 1:
                    self._switch(OUTPUTS_AT[sort] + bit, on=bool(bits >> bit & 1))

    def _switch(self, bit: int, *, on: bool) -> None:
        if "stuck_output" not in self._faults:
            self.outputs = self.outputs & ~(1 << bit) | (on << bit)

    def _move(self, now: float, goal: Joints, named: Mapping[str, float]) -> None:
        joints = self.drive.joints
        if "lie" in self._faults:
            return
        if "short" in self._faults:
            goal = (goal[0] - math.copysign(SHORT_RAD, goal[0] - joints[0]), *goal[1:])
        ways = [abs(b - a) for a, b in zip(joints, goal, strict=True)]
        share = self.slider * (0.1 if "slow" in self._faults else 1.0)
        self.drive.path = between(
            joints,
            goal,
            now,
            speed=named.get("v", 1.05) * share,
            acceleration=named.get("a", 1.4),
            leading=ways.index(max(ways)),
        )

    def travel(self, now: float) -> None:
        if self.drive.travel(now):
            self._note_runtime(now)

    # What it shows.

    @property
    def runtime(self) -> Runtime:
        """The state of the program."""
        if self._resumes is not None or (self.name and self._arm.safety != NORMAL):
            return Runtime.PAUSED
        if self.name:
            return Runtime.PLAYING
        return Runtime.STOPPED if self.drive.path is None else Runtime.STOPPING

    def _note_runtime(self, now: float) -> None:
        if not self._shown or self._shown[-1][1] != self.runtime:
            self._shown.append((now, self.runtime))
        while len(self._shown) > 2 and self._shown[1][0] <= now - LATE_RUNTIME_S:
            self._shown.popleft()

    def shown_runtime(self, now: float) -> Runtime:
        """The state that is told, which may be late."""
        self._note_runtime(now)
        if "late_runtime" not in self._faults:
            return self.runtime
        old = [state for at, state in self._shown if at <= now - LATE_RUNTIME_S]
        return old[-1] if old else self._shown[0][1]
