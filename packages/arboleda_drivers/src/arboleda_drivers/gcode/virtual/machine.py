"""Virtual machine of three axes: motion, and what comes of its lines. No line of its own, no clock."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

WORD = re.compile(r"([XYZF])(-?\d+(?:\.\d+)?)")
SHORT_MM = 2.0
FASTEST_MM_S = 100.0
Place = tuple[float, ...]
ZERO: Place = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Path:
    """Straight way at one speed, from a time on; `stalled_at`: when it stood still, if it does."""

    start: Place
    goal: Place
    began_at: float
    mm_s: float
    stalled_at: float = math.inf

    @property
    def length(self) -> float:
        return math.dist(self.start, self.goal)

    @property
    def ends_at(self) -> float:
        return self.began_at + self.length / self.mm_s

    @property
    def half_way_at(self) -> float:
        return (self.began_at + self.ends_at) / 2

    def at(self, now: float) -> Place:
        part = 1.0 if now >= self.ends_at else max(0.0, now - self.began_at) * self.mm_s / self.length
        return tuple(a + (b - a) * part for a, b in zip(self.start, self.goal, strict=True))


class VirtualMachine:
    """Virtual machine; `faults` are looked up when they matter. Times in s of any clock, places in mm."""

    def __init__(self, faults: Collection[str]) -> None:
        self.faults = faults
        self.place = ZERO
        self._now = 0.0
        self._lines = 0

    @property
    def is_unplugged(self) -> bool:
        """True while there is no line."""
        return "unplugged" in self.faults

    def _path_to(self, begins_at: float, start: Place, words: Mapping[str, float]) -> Path | None:
        """The way that the words of a move lead from `start`; None if it leads nowhere."""
        goal = tuple(words.get(letter, here) for letter, here in zip("XYZ", start, strict=True))
        length = math.dist(start, goal)
        if "short" in self.faults and length > SHORT_MM:
            part = 1 - SHORT_MM / length
            goal = tuple(a + (b - a) * part for a, b in zip(start, goal, strict=True))
        if length == 0 or "lie" in self.faults:
            return None
        speed = min(words.get("F", 600.0) / 60, FASTEST_MM_S) * (0.1 if "slow" in self.faults else 1.0)
        return Path(start=start, goal=goal, began_at=begins_at, mm_s=speed)

    def _sent(self, lines: Sequence[str]) -> bytes:
        """The bytes of these lines, as they come out of the line."""
        return b"" if "mute" in self.faults else b"".join(map(self._bytes, lines))

    def _bytes(self, line: str) -> bytes:
        self._lines += 1
        data = line.encode("ascii") + b"\r\n"
        if "torn" in self.faults and self._lines % 3 == 0:
            data = data[:-3]
        return b"\x00~~<|\r\n" + data if "noise" in self.faults else data


def words_of(line: str) -> dict[str, float]:
    """The letters of a line of G-code with their numbers."""
    return {letter: float(value) for letter, value in WORD.findall(line)}
