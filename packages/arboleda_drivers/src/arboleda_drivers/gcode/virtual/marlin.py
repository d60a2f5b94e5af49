"""Virtual machine with Marlin: numbered lines, a queue, motion, and stops that pass the queue."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Collection
from functools import reduce
from operator import xor

from .machine import ZERO, Path, Place, VirtualMachine, words_of

NUMBERED = re.compile(r"N(\d+) (.*)\*(\d+)")
AT_ONCE = re.compile(r"(?:N\d+ )?(M410|M112)(?:\*\d+)?")
HOMING_S, DROPS_S, KEEPALIVE_S = 1.0, 1.0, 2.0
DIES_S = 0.6  # for so long it moves on after it has said that it is halted
SLIP_MM = 3.0
STEPS_PER_MM = 80
HALTED = "Error:Printer halted. kill() called!"
STOPPED = "Error:Printer stopped due to errors. Fix the error and use M999 to restart."


class VirtualMarlin(VirtualMachine):
    """Virtual machine with Marlin; `place` is where it is, which it does not see: it counts steps."""

    def __init__(self, faults: Collection[str] = ()) -> None:
        super().__init__(faults)
        self._rest = b""
        self._was_off = False
        self._numbers = self._answers = 0
        self._disturbed: Path | None = None
        self._begin()

    @property
    def next_deadline(self) -> float:
        """The time at which something becomes so by itself."""
        ends = min(self._path.ends_at, self._dies_at) if self._path is not None else math.inf
        drops = self._drops_until if self._drops_until > self._now else math.inf
        busy = self._busy_at if self._is_busy else math.inf
        return min(ends, self._homes_at, drops, busy)

    def step(self, now: float, data: bytes = b"") -> bytes:
        """Let time pass, take bytes from the line, and return those that come back."""
        self._now = now
        out = self._pass_time(now)
        if self.is_unplugged or "boot" in self.faults:
            return b""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for each in lines:
            out += self._take(now, each.decode("ascii", "replace").strip())
        return self._sent(out + self._go_on(now))

    @property
    def needs_reset(self) -> bool:
        """True from an error on until it is reset."""
        return self._is_halted or self._is_stopped

    def press_reset(self) -> None:
        """Reset its controller, as with the button on its board."""
        self._was_off = True

    def push_to_zero(self) -> None:
        """Have somebody push its axes to their zero, which it does not see."""
        self.place = ZERO
        self._slip = tuple(-at for at in self._counted)

    # How time passes.

    def _begin(self) -> None:
        self._rest, self._last_number = b"", 0
        self._queue: deque[str] = deque()
        self._path: Path | None = None
        self._counted = self._goal = ZERO
        self._slip = self.place  # where it is when it counts from 0
        self._homes_at = math.inf
        self._drops_until = -math.inf  # Marlin drops all moves for a while after a stop
        self._waits = False  # in M400
        self._keepalive_s, self._busy_at = KEEPALIVE_S, math.inf
        self._is_halted = self._is_stopped = False
        self._dies_at = math.inf

    def _stand(self, counted: Place) -> None:
        self._counted = counted
        self.place = tuple(at + slip for at, slip in zip(counted, self._slip, strict=True))

    def _pass_time(self, now: float) -> list[str]:
        off = "boot" in self.faults
        if self._was_off and not off:
            self._begin()
            self._was_off = False
            return ["start", "echo:Marlin 2.1.2"]
        self._was_off = off
        out = [] if self._is_halted else self._protect()
        if self._path is not None:
            said = self._travel(min(now, self._dies_at), self._path)
            out += [] if self._is_halted else said
        if self._dies_at <= now:
            self._path = None
        if self._homes_at <= now:
            out += self._end_homing()
        return out + self._go_on(now)

    def _protect(self) -> list[str]:
        if "killed" in self.faults:
            return self._kill()
        if "stopped" in self.faults and not self._is_stopped:
            self._is_stopped = True
            return [STOPPED]
        return []

    def _travel(self, now: float, path: Path) -> list[str]:
        half = now >= path.half_way_at
        if "stall" in self.faults and half:
            return []
        self._stand(path.at(now))
        if half and "endstop_hit" in self.faults:
            self._path = None  # and it says afterwards that it is at its goal
            return [f"echo:endstops hit:  X:{self._counted[0]:.2f}"]
        if half and "second_client" in self.faults and path is not self._disturbed:
            self._goal = (path.goal[0] + 10.0, *path.goal[1:])
            self._path = self._disturbed = Path(
                start=self._counted, goal=self._goal, began_at=now, mm_s=path.mm_s
            )
        elif path.ends_at <= now:
            self._path = None
        return []

    def _end_homing(self) -> list[str]:
        self._homes_at = math.inf
        if "homing_fails" in self.faults:
            return ["echo:Homing Failed", *self._kill()]
        self._slip = ZERO
        self._goal = ZERO
        self._stand(ZERO)
        return ["ok"]

    def _kill(self) -> list[str]:
        self._is_halted, self._dies_at = True, self._now + DIES_S
        self._homes_at, self._waits = math.inf, False
        self._queue.clear()
        return [HALTED]

    def _quick_stop(self, now: float) -> None:
        if self._path is not None and "slips" in self.faults:
            self._slip = (self._slip[0] + SLIP_MM, *self._slip[1:])
        self._path, self._goal = None, self._counted
        self._stand(self._counted)
        self._drops_until = min(max(now, self._drops_until), now + DROPS_S) + DROPS_S  # one stop may wait

    # Lines.

    @property
    def _is_busy(self) -> bool:
        moves = self._path is not None and self._waits
        return moves or self._homes_at < math.inf or self._drops_until > self._now

    def _take(self, now: float, line: str) -> list[str]:
        if self._is_halted or not line:
            return []
        found = AT_ONCE.fullmatch(line)
        if found is not None and not {"deaf", "no_parser"} & set(self.faults):
            if found[1] == "M112":
                return self._kill()
            if self._homes_at == math.inf:  # or only a leg of the homing would end
                self._quick_stop(now)
        if line.startswith("N"):
            self._numbers += 1
            numbered = NUMBERED.fullmatch(line)
            if numbered is None or not self._is_next(numbered):
                return [
                    f"Error:checksum mismatch, Last Line: {self._last_number}",
                    f"Resend: {self._last_number + 1}",
                    "ok",
                ]
            self._last_number, line = int(numbered[1]), numbered[2]
        self._queue.append(line)
        return []

    def _is_next(self, found: re.Match[str]) -> bool:
        text = found[0].rpartition("*")[0]
        if "mistaken" in self.faults and self._numbers % 7 == 0:
            return False
        follows = int(found[1]) == self._last_number + 1 or "M110" in found[2]
        return follows and int(found[3]) == reduce(xor, text.encode("ascii"))

    def _go_on(self, now: float) -> list[str]:
        out: list[str] = []
        while not self._is_halted and not self._is_busy:
            if self._waits:
                self._waits = False
                out.append("ok")
            elif self._queue:
                out += self._do(now, self._queue.popleft())
            else:
                break
        if not self._is_busy or self._is_halted:
            self._busy_at = math.inf
        elif self._busy_at == math.inf:
            self._busy_at = now + self._keepalive_s
        elif self._busy_at <= now:
            self._busy_at = now + self._keepalive_s
            out.append("echo:busy: processing")
        return out

    def _do(self, now: float, line: str) -> list[str]:
        if line == "M400":
            self._waits = True
            return []
        if line.startswith("G28"):
            self._homes_at = now + HOMING_S
            return []
        if line.startswith("G1"):
            return self._move(now, line)
        if line.startswith("G92"):
            self._slip, self._goal = self.place, ZERO
            self._stand(ZERO)
        if line.startswith("M110"):
            self._last_number = int(line.partition("N")[2] or 0)  # a second time, after it was read
        if line == "M114":
            return [self._position_line(), "ok"]
        if line == "M115":
            parser = 0 if "no_parser" in self.faults else 1
            return ["FIRMWARE_NAME:Marlin 2.1.2 (virtual)", f"Cap:EMERGENCY_PARSER:{parser}", "ok"]
        if line.startswith("M113"):
            if "no_keepalive" in self.faults:
                return [f'echo:Unknown command: "{line}"', "ok"]
            self._keepalive_s = float(line.partition("S")[2] or KEEPALIVE_S)
        elif line in ("M410", "M112") and "no_parser" in self.faults:
            if line == "M112":
                return self._kill()
            self._quick_stop(now)
        return ["ok"]

    def _move(self, now: float, line: str) -> list[str]:
        if self._is_stopped:
            return [STOPPED, "ok"]
        if "motors_off" in self.faults:
            return ["echo:Home XYZ First", "ok"]
        if "unknown" in self.faults:
            return [f'echo:Unknown command: "{line}"', "ok"]
        self._path = self._path_to(now, self._counted, words_of(line))
        if self._path is not None:
            self._goal = self._path.goal
        return [] if "no_ok" in self.faults else ["ok"]

    def _position_line(self) -> str:
        self._answers += 1
        x, y, z = self._goal
        text = f"X:{x:.2f} Y:{y:.2f} Z:{z:.2f} E:0.00"
        if "garbled" in self.faults and self._answers % 2:
            text = text.replace(".", "?")
        steps = " ".join(
            f"{letter}:{at * STEPS_PER_MM:.0f}" for letter, at in zip("XYZ", self._counted, strict=True)
        )
        return f"{text} Count {steps}"
