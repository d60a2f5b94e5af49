"""Lines of a controller with GRBL 1.1 or of its kin: answers, alarms, status reports between angle brackets.

Source: GRBL's own documents `doc/markdown/interface.md` and `doc/csv/alarm_codes_en_US.csv`, version 1.1h.
What others say otherwise is in `report.c` of grblHAL/core and `FluidNC/src/Report.cpp` of bdring/FluidNC.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

from .lines import NUMBER, millimetres

HOLD, RESET, QUERY = b"!", b"\x18", b"?"  # single bytes, which pass all lines that wait
ASK_LOCK = ("$I", "$$")  # the lines whose answers have the signs of a lock
OK = "ok"
STATUS = re.compile(r"<([A-Z][a-z]+)(?::(\d{1,3}))?\|([^<>]*)>")
CODE = re.compile(r"(error|ALARM):(\d{1,3})")
POSITION = re.compile(rf"{NUMBER}(,{NUMBER}){{0,8}}")
BANNER = re.compile(r"(Grbl(?:HAL)?) \d+\.\d\w* \[(FluidNC)?.*\]")
DEMAND = re.compile(r"\[MSG:.*Reset\sto\scontinue\]")
LOCK_SIGN = re.compile(r"(\$22)=(\d{1,5})|\[(VER|OPT):(.*)\]")
LOCK_SIGNS = 3
CRITICAL = (1, 2)  # after these alarms it hears nothing but a reset
LOCKS = {"GrblHAL": 11, "FluidNC": 14}  # the alarm by which it says that it has to be homed first
ALARMS = {
    1: "hard_limit",
    2: "soft_limit",
    3: "abort_in_motion",
    4: "probe",
    5: "probe",
    6: "homing_reset",
    7: "homing_door",
    8: "homing_pull_off",
    9: "homing_no_switch",
}
ERRORS = {
    5: "homing_is_off",
    8: "not_idle",
    9: "locked",
    13: "door",
    15: "beyond_travel",
    20: "unknown_command",
}


class State(Enum):
    """State of the controller, the first word of a status report."""

    IDLE = "Idle"
    RUN = "Run"
    HOLD = "Hold"
    JOG = "Jog"
    ALARM = "Alarm"
    DOOR = "Door"
    CHECK = "Check"
    HOME = "Home"
    SLEEP = "Sleep"
    TOOL = "Tool"  # grblHAL waits for somebody to change its tool
    STARTING = "Starting"  # FluidNC


STATES = {each.value: each for each in State}
HOMED = {"0": False, "1": True}


@dataclass(frozen=True, kw_only=True)
class Status:
    """Status report; `position` is that of the machine, mm; `part` the number after the state, if any."""

    state: State
    part: int | None = None
    position: tuple[float, ...] = ()
    door: bool = False  # its pin says open
    homed: bool | None = None  # grblHAL says it where that has changed


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer to one line: `error` 0 is ok."""

    error: int = 0

    @property
    def word(self) -> str:
        return ERRORS.get(self.error, f"error_{self.error}")


@dataclass(frozen=True, kw_only=True)
class Alarm:
    """Alarm that was thrown just now."""

    code: int

    @property
    def word(self) -> str:
        return ALARMS.get(self.code, f"alarm_{self.code}")


@dataclass(frozen=True, kw_only=True)
class Banner:
    """Line by which the controller says that it has begun anew."""

    firmware: str = "Grbl"


@dataclass(frozen=True, kw_only=True)
class Demand:
    """Line by which the controller says that it hears nothing but a reset."""


@dataclass(frozen=True, kw_only=True)
class LockSign:
    """Line that says whether the controller locks itself when it boots; of each name it has to be so."""

    name: str
    locks: bool


Line = Status | Answer | Alarm | Banner | Demand | LockSign


def parsed(text: str) -> Line | None:
    """The meaning of a line; None if it has none."""
    if text == OK:
        return Answer()
    if found := CODE.fullmatch(text):
        number = int(found[2])
        if number == 0:
            return None
        return Answer(error=number) if found[1] == "error" else Alarm(code=number)
    if found := BANNER.fullmatch(text):
        return Banner(firmware=found[2] or found[1])
    if DEMAND.fullmatch(text):
        return Demand()
    if found := LOCK_SIGN.fullmatch(text):
        return _lock_sign(found[1] or found[3], found[2] or found[4])
    found = STATUS.fullmatch(text)
    return None if found is None else _status(found[1], found[2], found[3].split("|"))


def _lock_sign(name: str, value: str) -> LockSign:
    """The sign of a lock in a setting, or in a line of `$I`; that of FluidNC does not count."""
    if name == "VER":
        locks = value.startswith("1.1") and "FluidNC" not in value
    else:
        locks = "L" not in value.split(",")[0] if name == "OPT" else int(value) % 2 == 1
    return LockSign(name=name, locks=locks)


def _status(word: str, part: str | None, fields: list[str]) -> Status | None:
    state = STATES.get(word)
    values = dict(field.split(":", 1) for field in fields if ":" in field)
    position = _position(values.get("MPos", ""))
    if state is None or position is None:
        return None
    return Status(
        state=state,
        part=None if part is None else int(part),
        position=position,
        door="D" in values.get("Pn", ""),
        homed=HOMED.get(values.get("H", "")[:1]),
    )


def _position(text: str) -> tuple[float, ...] | None:
    """The numbers of a position; empty where there is none, None where it cannot be one."""
    if not text:
        return ()
    return millimetres(text.split(",")) if POSITION.fullmatch(text) else None
