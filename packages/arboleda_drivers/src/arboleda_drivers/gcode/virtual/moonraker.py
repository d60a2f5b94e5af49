"""Virtual machine with Klipper behind Moonraker: JSON-RPC, scripts in their order, and a queue of moves."""

from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from .machine import Path, Place, VirtualMachine, words_of

TICK_S = 0.25  # questions are answered at the next one
BEGINS_S, HOMING_S, BOOT_S = 0.25, 1.0, 0.5
AHEAD_S = 1.0  # where more is planned, the next script waits
ZERO: Place = (0.0, 0.0, 0.0)
LEAST, MOST = (-10.0, -10.0, -10.0), (400.0, 400.0, 100.0)
OFFSET: Place = (7.0, -3.0, 1.0)
READY, STARTUP, SHUTDOWN, ERROR, GONE = "ready", "startup", "shutdown", "error", ""
NO_KLIPPER, NO_RIGHT = (503, "Klippy Host not connected"), (401, "Unauthorized")
NOT_HOMED = "Must home axis first: 1.000 0.000 0.000 [0.000]"
NO_SWITCH = "No trigger on x after full movement"


@dataclass(kw_only=True)
class Script:
    """Script of a client that has the number of its request, and its lines that are left."""

    number: int
    lines: deque[str]
    waits: bool = False  # for all moves


@dataclass(kw_only=True)
class Klipper:
    """Memory of Klipper, from its start to its end."""

    state: str = READY
    is_homed: bool = False
    place: Place = ZERO  # where its steppers are by its count
    planned: Place = ZERO
    ordered: Place = ZERO
    paths: deque[Path] = field(default_factory=deque)
    scripts: deque[Script] = field(default_factory=deque)
    homes_at: float = math.inf
    stalls: bool = False

    def ends_at(self, now: float) -> float:
        return math.inf if self.stalls else self.paths[-1].ends_at if self.paths else now


class VirtualMoonraker(VirtualMachine):
    """Virtual machine with Klipper; `place` is where it is, which Klipper does not see: it counts steps."""

    def __init__(self, faults: Collection[str] = ()) -> None:
        super().__init__(faults)
        self._rest = b""
        self._klipper = Klipper()
        self._origin = ZERO  # where it is when Klipper counts from 0
        self._questions: list[int] = []
        self._tick_at = 0.0
        self._boots_at = math.inf
        self._statuses = 0
        self._ended_at = -math.inf  # of the last move
        self._disturbed: Path | None = None

    @property
    def next_deadline(self) -> float:
        """The time at which something becomes so by itself."""
        ends = self._klipper.ends_at(math.inf)
        half = self._klipper.paths[0].half_way_at if self._klipper.paths else math.inf
        waits = self._tick_at if self._klipper.scripts or self._questions else math.inf
        times = (ends, half, waits, self._klipper.homes_at, self._boots_at)
        return min((each for each in times if each > self._now), default=math.inf)

    def step(self, now: float, data: bytes = b"") -> bytes:
        """Let time pass, take bytes from the line, and return those that come back."""
        self._now = now
        out = self._pass_time(now)
        if self.is_unplugged:
            self._rest, self._questions = b"", []
            return b""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for each in lines:
            out += self._take(each.strip())
        return self._sent([*out, *self._run(now), *self._tell(now)])

    @property
    def needs_reset(self) -> bool:
        """True from a shutdown or an error on until its firmware is restarted."""
        return self._klipper.state in (SHUTDOWN, ERROR)

    def press_reset(self) -> None:
        """Restart its firmware, as somebody does on a page of the printer."""
        self._boots_at = self._now + BOOT_S
        self._klipper = Klipper(state=GONE)
        self._origin = self.place

    # How time passes.

    def _pass_time(self, now: float) -> list[str]:
        out = []
        if "boot" in self.faults and self._klipper.state != GONE:
            out += [_notice("notify_klippy_disconnected"), *self._fail_all(*NO_KLIPPER)]
            self.press_reset()
        if self._boots_at <= now and "boot" not in self.faults:
            if self._klipper.state == GONE:
                self._klipper, self._boots_at = Klipper(state=STARTUP), now + BOOT_S
            else:
                self._klipper.state, self._boots_at = READY, math.inf
        if self._klipper.state == READY:
            out += self._protect() + self._travel(now)
        return out

    def _protect(self) -> list[str]:
        if "shutdown" in self.faults:
            return self._shut_down(SHUTDOWN)
        if "error" in self.faults:
            return self._shut_down(ERROR)
        if "motors_off" in self.faults and not self._klipper.paths:
            self._klipper.is_homed = False
        return []

    def _shut_down(self, state: str) -> list[str]:
        out = self._fail_all(400, "Printer is shutdown")
        self._klipper.state, self._klipper.homes_at = state, math.inf
        self._klipper.paths.clear()
        self._klipper.planned = self._klipper.ordered = self._klipper.place
        return [*out, _notice("notify_klippy_shutdown")]

    def _fail_all(self, code: int, message: str) -> list[str]:
        scripts, self._klipper.scripts = self._klipper.scripts, deque()
        return [refused(each.number, code, message) for each in scripts]

    def _travel(self, now: float) -> list[str]:
        klipper = self._klipper
        while klipper.paths:
            path = klipper.paths[0]
            half = now >= path.half_way_at
            if half and ("stall" in self.faults or klipper.stalls):
                klipper.stalls = True
                break
            self._stand(path.at(now))
            if half and "second_client" in self.faults and self._disturbed is not path:
                self._add((klipper.planned[0] + 10.0, *klipper.planned[1:]), path.mm_s)
                self._disturbed = klipper.paths[-1]
            if path.ends_at > now:
                break
            self._ended_at = path.ends_at
            klipper.paths.popleft()
        if klipper.homes_at <= now:
            return self._end_homing()
        return []

    def _stand(self, counted: Place) -> None:
        self._klipper.place = counted
        self.place = tuple(at + origin for at, origin in zip(counted, self._origin, strict=True))

    def _end_homing(self) -> list[str]:
        self._klipper.homes_at = math.inf
        number = self._klipper.scripts.popleft().number
        if "homing_fails" in self.faults:
            return [refused(number, 400, NO_SWITCH)]
        self._origin, self._klipper.is_homed = ZERO, True
        self._klipper.planned = self._klipper.ordered = ZERO
        self._stand(ZERO)
        return [answered(number, "ok")]

    # Requests.

    def _take(self, line: bytes) -> list[str]:
        try:
            found = json.loads(line)
        except ValueError:
            return []
        number, method, params = found["id"], found["method"], found.get("params", {})
        if "no_key" in self.faults:
            return [refused(number, *NO_RIGHT)]
        if method == "server.connection.identify":
            return [answered(number, {"connection_id": 1})]
        if self._klipper.state == GONE:
            return [refused(number, *NO_KLIPPER)]
        if method == "printer.objects.query":
            self._questions.append(number)
        elif method == "printer.emergency_stop":
            return [] if "deaf" in self.faults else [*self._shut_down(SHUTDOWN), answered(number, "ok")]
        elif method == "printer.firmware_restart":
            self.press_reset()
            return [_notice("notify_klippy_disconnected"), answered(number, "ok")]
        elif self._klipper.state != READY:
            return [refused(number, 400, "Printer is not ready")]
        else:
            self._klipper.scripts.append(Script(number=number, lines=deque(params["script"].split("\n"))))
        return []

    def _run(self, now: float) -> list[str]:
        """Run scripts, each to its end before the next one begins."""
        out: list[str] = []
        klipper = self._klipper
        while klipper.scripts and klipper.homes_at == math.inf and "busy_elsewhere" not in self.faults:
            script = klipper.scripts[0]
            line = script.lines.popleft() if script.lines else ""
            refusal = self._do(now, line)
            script.waits = script.waits or line == "M400"
            if klipper.homes_at < math.inf or (refusal is None and script.lines):
                continue
            if refusal is None and klipper.ends_at(now) - now > (0.0 if script.waits else AHEAD_S):
                break
            klipper.scripts.popleft()
            if refusal is not None:
                out.append(refused(script.number, 400, refusal))
            elif "no_ok" not in self.faults:
                out.append(answered(script.number, "ok"))
        return out

    def _do(self, now: float, line: str) -> str | None:
        """Do a line; returns why not, if it is refused."""
        klipper = self._klipper
        if line.startswith("G28"):
            klipper.is_homed, klipper.homes_at = False, now + HOMING_S
        elif line.startswith("G1"):
            if "refuses" in self.faults:
                return "Error evaluating a macro"
            if not klipper.is_homed:
                return NOT_HOMED
            words = words_of(line)
            pairs = zip("XYZ", self._base, klipper.ordered, strict=True)
            goal = tuple(words.get(letter, at - base) + base for letter, base, at in pairs)
            self._add(goal, words.get("F", 600.0) / 60)
        return None

    def _add(self, goal: Place, mm_s: float) -> None:
        """Plan a way to its end, from the end of all before it."""
        klipper = self._klipper
        begins_at = klipper.ends_at(self._now + BEGINS_S)
        klipper.ordered = goal
        words = {**dict(zip("XYZ", goal, strict=True)), "F": mm_s * 60}
        path = self._path_to(begins_at, klipper.planned, words)
        if path is not None:
            klipper.planned = path.goal
            klipper.paths.append(path)

    @property
    def _base(self) -> Place:
        return OFFSET if "offset" in self.faults else ZERO

    # What it tells.

    def _tell(self, now: float) -> list[str]:
        if now < self._tick_at:
            return []
        self._tick_at = now + TICK_S
        questions, self._questions = self._questions, []
        if self._klipper.state == GONE:
            return [refused(each, *NO_KLIPPER) for each in questions]
        return [answered(each, {"eventtime": now, "status": self._status(now)}) for each in questions]

    def _status(self, now: float) -> Mapping[str, Any]:
        self._statuses += 1
        klipper = self._klipper
        if klipper.state == STARTUP:
            return {"webhooks": {"state": STARTUP}, "toolhead": {}, "motion_report": {}, "gcode_move": {}}
        path = klipper.paths[0] if klipper.paths else None
        moves = path is not None and not klipper.stalls and path.began_at < now
        ends_at = now + 1.0 if klipper.stalls else klipper.ends_at(self._ended_at)
        live: list[Any] = [*klipper.place, 0.0]
        if "garbled" in self.faults and self._statuses % 2:
            live[0] = "?"
        report = {"live_position": live, "live_velocity": path.mm_s if moves and path is not None else 0.0}
        return {
            "webhooks": {"state": klipper.state},
            "toolhead": {
                "position": [*klipper.planned, 0.0],
                "homed_axes": "xyz" if klipper.is_homed else "",
                "axis_minimum": [*LEAST, 0.0],
                "axis_maximum": [*MOST, 0.0],
                "max_velocity": 300.0,
                "print_time": max(ends_at, now + 0.1) if klipper.paths else max(ends_at, 0.0),
                "estimated_print_time": now,
            },
            "motion_report": {} if "no_position" in self.faults else report,
            "gcode_move": {
                "position": [*klipper.ordered, 0.0],
                "gcode_position": [
                    *(at - base for at, base in zip(klipper.ordered, self._base, strict=True)),
                    0.0,
                ],
            },
        }


def _notice(method: str) -> str:
    return json.dumps({"jsonrpc": "2.0", "method": method})


def answered(number: int, result: object) -> str:
    """The line of an answer."""
    return json.dumps({"jsonrpc": "2.0", "result": result, "id": number})


def refused(number: int, code: int, message: str) -> str:
    """The line of an answer that refuses."""
    return json.dumps({"jsonrpc": "2.0", "error": {"code": code, "message": message}, "id": number})
