"""Virtual machine with GRBL: lines, single bytes, motion and status reports."""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from dataclasses import replace

from .machine import ZERO, Path, Place, VirtualMachine, words_of

BANNER = "Grbl 1.1h ['$' for help]"
LOCKED_MESSAGE = "[MSG:'$H'|'$X' to unlock]"
BUILD = ("[VER:1.1h.20190830:]", "[OPT:V,15,128]", "ok")
STATUS_BYTE, HOLD_BYTE, RESUME_BYTE, RESET_BYTE = b"?", b"!", b"~", b"\x18"
MODALS = re.compile(r"(G\d+(?:\.\d)?|[XYZF]-?\d+(?:\.\d+)?)*")
HOLD_S, HOMING_S, LATE_S = 0.1, 1.5, 0.3
HARD_LIMIT, SOFT_LIMIT, ABORT, HOMING_RESET, NO_SWITCH = 1, 2, 3, 6, 9
CRITICAL = (HARD_LIMIT, SOFT_LIMIT)  # it hears nothing but a reset then, and says nothing
UNKNOWN, HOMING_OFF, LOCKED, NOT_IDLE, DOOR, BEYOND = 20, 5, 9, 8, 13, 15


class VirtualGrbl(VirtualMachine):
    """Virtual machine with GRBL; `place` is where it is, counted from where it was homed or has booted."""

    banner = BANNER

    def __init__(self, faults: Collection[str] = (), *, homed: bool = False) -> None:
        super().__init__(faults)
        self._locked = not homed
        self._is_critical = False
        self._homing_on = True  # its setting $22, which outlives a boot
        self._zero: Place = ZERO  # the place where it counts 0
        self._rest = b""
        self._statuses = 0
        self._was_off = self._was_asleep = False
        self._disturbed: Path | None = None
        self._stop_all()

    @property
    def next_deadline(self) -> float:
        """The time at which something becomes so by itself."""
        ends = [self._path.ends_at] if self._path is not None and not self._held else []
        return min([*ends, self._homes_at, self._hold_at if self._hold_at > self._now else math.inf])

    def step(self, now: float, data: bytes = b"") -> bytes:
        """Let time pass, take bytes from the line, and return those that come back."""
        self._now = now
        out = self._pass_time(now)
        if self.is_unplugged or "boot" in self.faults:
            return b""
        for at in range(len(data)):
            out += self._take(now, data[at : at + 1])
        return self._sent(out)

    def begin_at_zero(self) -> None:
        """Have somebody switch it off, push it to its zero and switch it on, unless it counts 0 there."""
        if self.place != ZERO or self._count != ZERO:
            self.place, self._was_off = ZERO, True

    @property
    def _count(self) -> Place:
        return tuple(at - zero for at, zero in zip(self.place, self._zero, strict=True))

    # How time passes.

    def _stop_all(self) -> None:
        self._path: Path | None = None
        self._hold_at = math.inf  # when it stands after a feed hold
        self._homes_at = math.inf

    @property
    def _held(self) -> bool:
        return self._hold_at < math.inf

    def _pass_time(self, now: float) -> list[str]:
        off = "boot" in self.faults
        if self._was_off and not off:
            self._stop_all()
            self._locked, self._zero, self._rest = self._homing_on, self.place, b""
            self._was_off = self._is_critical = False
            return self._greeting
        self._was_off = off
        self._was_asleep = self._was_asleep or "asleep" in self.faults
        if self._path is not None:
            return self._travel(now, self._path)
        if self._homes_at <= now:
            self._homes_at = math.inf
            if "homing_fails" in self.faults:
                return self._alarm(NO_SWITCH)
            self._locked, self.place, self._zero = False, ZERO, ZERO
            return ["ok"]
        return []

    def _travel(self, now: float, path: Path) -> list[str]:
        half = now >= path.half_way_at
        if "stall" in self.faults and half:
            self._path = replace(path, stalled_at=min(path.stalled_at, now))
            return []
        if path.stalled_at < now:  # it goes on from where it stands
            path = replace(path, began_at=path.began_at + now - path.stalled_at, stalled_at=math.inf)
            self._path = path
            self._hold_at = max(self._hold_at, now)
        if self._held:
            self.place = path.at(min(now, self._hold_at))
            return []
        self.place = path.at(now)
        if half and "hard_limit" in self.faults:
            return self._alarm(HARD_LIMIT)
        if ("door" in self.faults) or (half and "hold_pressed" in self.faults):
            self._hold_at = now + HOLD_S
        elif half and "second_client" in self.faults and path is not self._disturbed:
            goal = (path.goal[0] + 10.0, *path.goal[1:])
            self._path = self._disturbed = Path(start=self.place, goal=goal, began_at=now, mm_s=path.mm_s)
        elif path.ends_at <= now:
            self._path = None
        return []

    def _alarm(self, code: int) -> list[str]:
        self._stop_all()
        self._locked, self._is_critical = True, code in CRITICAL
        return [f"ALARM:{code}", *(["[MSG:Reset to continue]"] if self._is_critical else self._greeting)]

    @property
    def _greeting(self) -> list[str]:
        return ["", self.banner, *([LOCKED_MESSAGE] if self._locked else [])]

    # Bytes and lines.

    def _take(self, now: float, byte: bytes) -> list[str]:
        if self._is_critical and byte != RESET_BYTE:
            return []
        if byte == STATUS_BYTE:
            return self._status(now) if self._homes_at == math.inf else []
        if byte == HOLD_BYTE:
            if "deaf" not in self.faults and not self._held and self._homes_at == math.inf:
                self._hold_at = now + (HOLD_S if self._path is not None else 0.0)
        elif byte == RESUME_BYTE:
            self._resume(now)
        elif byte == RESET_BYTE:
            return [] if "no_reset" in self.faults else self._reset(now)
        elif byte == b"\n":
            line, self._rest = self._rest, b""
            return self._line(now, line.decode("ascii", "replace").replace(" ", "").strip().upper())
        else:
            self._rest += byte
        return []

    def _resume(self, now: float) -> None:
        if self._held and "door" not in self.faults:
            if self._path is not None:
                path = self._path
                self._path = Path(start=self.place, goal=path.goal, began_at=now, mm_s=path.mm_s)
            self._hold_at = math.inf

    def _reset(self, now: float) -> list[str]:
        moves = (
            self._path is not None and not (self._held and self._hold_at <= now)
        ) or self._homes_at < math.inf
        code = HOMING_RESET if self._homes_at < math.inf else ABORT
        self._stop_all()
        self._is_critical = False
        self._rest, self._was_asleep = b"", "asleep" in self.faults
        self._locked = self._locked or moves
        return [*([f"ALARM:{code}"] if moves else []), *self._greeting]

    def _line(self, now: float, line: str) -> list[str]:
        if not line:
            return ["ok"]
        if line.startswith("$"):
            return self._system_line(now, line)
        if MODALS.fullmatch(line) is None:
            return [f"error:{UNKNOWN}"]
        if self._locked:
            return [f"error:{LOCKED}"]
        if "error" in self.faults:
            return [f"error:{BEYOND}"]
        return self._move(now, words_of(line))

    def _system_line(self, now: float, line: str) -> list[str]:
        if line == "$H" and not self._homing_on:
            return [f"error:{HOMING_OFF}"]
        if line in ("$H", "$X") and "door" in self.faults:
            return [f"error:{DOOR}"]
        if self._path is not None or self._held:
            return [f"error:{NOT_IDLE}"]
        if line == "$H":
            self._homes_at = now + HOMING_S
            return []
        if line == "$X":
            was_locked, self._locked = self._locked, False
            return ["[MSG:Caution: Unlocked]", "ok"] if was_locked else ["ok"]
        if line in ("$22=0", "$22=1"):
            self._homing_on = line.endswith("1")
            return ["ok"]
        if line == "$$":
            return ["$10=1", f"$22={int(self._homing_on)}", "ok"]
        return list(BUILD) if line == "$I" else [f"error:{UNKNOWN}"]

    def _move(self, now: float, words: dict[str, float]) -> list[str]:
        if "soft_limit" in self.faults:
            return self._alarm(SOFT_LIMIT)
        late = LATE_S if "late_start" in self.faults else 0.0
        there = {
            letter: at + (self._zero["XYZ".index(letter)] if letter in "XYZ" else 0.0)
            for letter, at in words.items()
        }
        self._path = self._path_to(now + late, self.place, there)
        return [] if "no_ok" in self.faults else ["ok"]

    @property
    def state(self) -> str:
        """The word, and the number, of its state."""
        if self._homes_at < math.inf:
            return "Home"
        if self._locked:
            return "Alarm"
        if self._was_asleep:
            return "Sleep"
        if "door" in self.faults:
            return "Door:1" if not self._held or self._hold_at <= self._now else "Door:2"
        if self._held:
            return "Hold:0" if self._hold_at <= self._now else "Hold:1"
        return "Run" if self._path is not None and self._path.began_at <= self._now else "Idle"

    def _status(self, now: float) -> list[str]:
        self._statuses += 1
        place = ",".join(f"{each:.3f}" for each in self._count)
        if "garbled" in self.faults and self._statuses % 2:
            place = place.replace(".", "?")
        name = "WPos" if "no_position" in self.faults else "MPos"
        pins = "|Pn:D" if "door" in self.faults else ""
        return [f"<{self.state}|{name}:{place}|FS:0,0{pins}>"]
