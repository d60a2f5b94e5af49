"""Lines of a controller with Marlin: numbered ones to it, and its answers, echoes and errors.

Source: the pages of M110, M112 to M115, M400 and M410 at https://marlinfw.org/meta/gcode/, and Marlin's own
`src/core/language.h`, `src/gcode/queue.cpp` and `src/module/motion.cpp`, versions 1.1 to 2.1.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import reduce
from operator import xor

from .lines import NUMBER, millimetres

OK = re.compile(r"ok(?: N\d+)?(?: P\d+ B\d+)?")
POSITION = re.compile(rf"(X:{NUMBER}(?: [A-Z]:{NUMBER})*) Count(?: ?[A-Z]: ?-?\d+(?:\.\d+)?)+")
AXIS = re.compile(rf"[XYZ]:({NUMBER})")
FIRMWARE = re.compile(r"FIRMWARE_NAME:(.+)")
CAPABILITY = re.compile(r"Cap:([A-Z_]+):([01])")
BUSY = re.compile(r"(?:echo:)?busy: ([a-z ]+)")
RESEND = re.compile(r"Resend: ?\d+|Error:.*Last Line: \d+")
UNKNOWN = re.compile(r"echo:Unknown command: .*")
HOME_FIRST = re.compile(r"echo:Home [XYZ]+ (?:Printer )?First")
ENDSTOP = re.compile(r"echo:endstops hit: .*")
HALTED, STOPPED, UNHOMED = "halted", "stopped", "not_homed"
PROTECTION = re.compile(rf"(?:Error:)?Printer ({HALTED}|{STOPPED})\b.*")


@dataclass(frozen=True, kw_only=True)
class Ok:
    """Answer to a line, in the order of the lines."""


@dataclass(frozen=True, kw_only=True)
class Place:
    """Answer to `M114`: the place, mm, at which the last move that was planned ends."""

    position: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Busy:
    """Sign of life of a controller that goes on with a line, or waits for somebody."""

    word: str


@dataclass(frozen=True, kw_only=True)
class Refusal:
    """Line before the `ok` of one that is not done."""

    word: str


@dataclass(frozen=True, kw_only=True)
class Trouble:
    """Line that tells of a failure; `word` is `halted` or `stopped` where it lasts until a reset."""

    word: str


@dataclass(frozen=True, kw_only=True)
class Resend:
    """Line that asks for another one again, as that came with a mistake."""


@dataclass(frozen=True, kw_only=True)
class Firmware:
    """First line of the answer to `M115`."""

    name: str


@dataclass(frozen=True, kw_only=True)
class Capability:
    """Line of the answer to `M115`: what the firmware was built with, or without."""

    name: str
    on: bool


@dataclass(frozen=True, kw_only=True)
class Start:
    """Line by which the controller says that it has begun anew."""


Line = Ok | Place | Busy | Refusal | Trouble | Resend | Firmware | Capability | Start


def numbered(number: int, line: str) -> str:
    """The line with its number and its checksum, so that a mistake in it is noticed."""
    text = f"N{number} {line}"
    return f"{text}*{reduce(xor, text.encode('ascii'))}"


def parsed(text: str) -> Line | None:
    """The meaning of a line; None if it has none."""
    if OK.fullmatch(text):
        return Ok()
    if found := POSITION.fullmatch(text):
        position = millimetres(AXIS.findall(found[1]))
        return None if position is None else Place(position=position)
    if found := BUSY.fullmatch(text):
        return Busy(word=found[1])
    if text == "start":
        return Start()
    if RESEND.fullmatch(text):
        return Resend()
    if found := CAPABILITY.fullmatch(text):
        return Capability(name=found[1], on=found[2] == "1")
    if found := FIRMWARE.fullmatch(text):
        return Firmware(name=found[1])
    return _trouble(text)


def _trouble(text: str) -> Line | None:
    if UNKNOWN.fullmatch(text):
        return Refusal(word="unknown_command")
    if HOME_FIRST.fullmatch(text):
        return Refusal(word=UNHOMED)
    if ENDSTOP.fullmatch(text):
        return Trouble(word="endstop_hit")
    if found := PROTECTION.fullmatch(text):
        return Trouble(word=found[1])
    return Trouble(word="error") if text.startswith("Error:") else None
