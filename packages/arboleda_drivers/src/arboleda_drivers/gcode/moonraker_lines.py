"""Lines of Moonraker: JSON-RPC 2.0, an object a line; its websocket sends each in a frame of its own.

Source: the pages of Moonraker's API, https://moonraker.readthedocs.io (`external_api`), Klipper's page on its
status, https://www.klipper3d.org/Status_Reference.html, and Klipper's own `klippy/webhooks.py`,
`klippy/toolhead.py` and `klippy/extras/gcode_move.py`, v0.13.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from .lines import FARTHEST_MM

Place = tuple[float, ...]
READY, DISCONNECTED, UNHOMED = "ready", "disconnected", "not_homed"
STATES = (READY, "startup", "shutdown", "error")
BEGINS = (DISCONNECTED, "startup")  # states of a Klipper that has ended, or begins anew
NOTICES = {"notify_klippy_shutdown": "shutdown", "notify_klippy_disconnected": DISCONNECTED}
OBJECTS = {
    "webhooks": ["state"],
    "toolhead": [
        "position",
        "homed_axes",
        "axis_minimum",
        "axis_maximum",
        "max_velocity",
        "print_time",
        "estimated_print_time",
    ],
    "motion_report": ["live_position", "live_velocity"],
    "gcode_move": ["position", "gcode_position"],
}
"""Fields to ask of Klipper's objects."""
WORDS = {
    "shutdown": re.compile(r".*shutdown", re.IGNORECASE | re.DOTALL),
    UNHOMED: re.compile(r"Must\shome\b"),
    "beyond_travel": re.compile(r"Move\sout\sof\srange\b"),
    "homing_no_switch": re.compile(r"No\strigger\son\b"),
    "homing_pull_off": re.compile(r"Endstop\s.*\sstill\striggered\b"),
}
"""Beginnings of the sentences by which Klipper refuses a line, by the word for each."""
NEAR_MM, STILL_MM_S = 0.01, 0.001


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Motion of the machine, mm and s: where it is, and what Klipper has taken.

    `place` is where its steppers are by the clock, `planned` where they will end, and `ordered` the end of
    the last line of G-code, before what a mesh of the bed adds; `base` is added to the words of a line.
    """

    place: Place
    speed: float
    planned: Place
    ordered: Place
    base: Place
    least: Place
    most: Place
    fastest: float
    homed_axes: str
    ahead_s: float  # of the queue that has been planned; below 0 where that has ended

    @property
    def stands(self) -> bool:
        """True where all that was planned is over."""
        return self.ahead_s <= 0 and self.speed < STILL_MM_S and near(self.place, self.planned)

    def has_homed(self, axes: Iterable[str]) -> bool:
        return all(letter in self.homed_axes for letter in axes)

    def allows(self, goal: Place) -> bool:
        """True where no axis is led beyond its travel; one that stays may be anywhere."""
        rows = zip(self.least, self.ordered, goal, self.most, strict=True)
        return all(at == here or a <= at <= b for a, here, at, b in rows)


@dataclass(frozen=True, kw_only=True)
class Status:
    """Klipper's state, and its motion where that can be read."""

    state: str
    motion: Motion | None


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer to the request with this number: what it tells, or why it was refused."""

    number: int
    code: int = 0
    refusal: str | None = None
    status: Status | None = None

    @property
    def word(self) -> str:
        """The word for why it was refused."""
        text = self.refusal or ""
        return next((word for word, pattern in WORDS.items() if pattern.match(text)), "error")


@dataclass(frozen=True, kw_only=True)
class Notice:
    """Word that comes by itself: Klipper has become this."""

    state: str


Line = Answer | Notice


def near(a: Place, b: Place) -> bool:
    """True for the same place, but for what rounding makes of it."""
    return all(abs(here - there) < NEAR_MM for here, there in zip(a, b, strict=True))


def request(number: int, method: str, params: Mapping[str, object]) -> str:
    """The line of a request."""
    return json.dumps({"jsonrpc": "2.0", "method": method, "params": params, "id": number})


def parsed(text: str) -> Line | None:
    """The meaning of a line; None if it has none."""
    try:
        found = json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError):
        return None
    if not isinstance(found, dict) or found.get("jsonrpc") != "2.0":
        return None
    number, method = found.get("id"), found.get("method")
    if isinstance(method, str):
        return Notice(state=NOTICES[method]) if method in NOTICES and number is None else None
    if type(number) is not int or ("result" in found) == ("error" in found):
        return None
    return _refused(number, found["error"]) if "error" in found else _told(number, found["result"])


def _no_number(text: str) -> float:
    raise ValueError(text)


def _refused(number: int, error: Any) -> Answer | None:
    if not isinstance(error, dict):
        return None
    code, message = error.get("code"), error.get("message")
    if type(code) is not int or not isinstance(message, str):
        return None
    return Answer(number=number, code=code, refusal=message)


def _told(number: int, result: Any) -> Answer:
    status = result.get("status") if isinstance(result, dict) else None
    return Answer(number=number, status=_status(status) if isinstance(status, dict) else None)


def _status(objects: Mapping[str, Any]) -> Status | None:
    rows = {name: objects.get(name) for name in OBJECTS}
    webhooks = rows["webhooks"]
    state = webhooks.get("state") if isinstance(webhooks, dict) else None
    if state not in STATES:
        return None
    try:
        return Status(state=state, motion=_motion(*(rows[name] for name in list(OBJECTS)[1:])))
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError):
        return Status(state=state, motion=None)


def _motion(toolhead: Any, report: Any, gcode: Any) -> Motion:
    """The motion of three objects; raises one of several errors where it is none."""
    homed_axes, ordered = toolhead["homed_axes"], _place(gcode["position"])
    if not isinstance(homed_axes, str):
        raise ValueError(homed_axes)
    return Motion(
        place=_place(report["live_position"]),
        speed=abs(_number(report["live_velocity"])),
        planned=_place(toolhead["position"]),
        ordered=ordered,
        base=tuple(a - b for a, b in zip(ordered, _place(gcode["gcode_position"]), strict=True)),
        least=_place(toolhead["axis_minimum"]),
        most=_place(toolhead["axis_maximum"]),
        fastest=_number(toolhead["max_velocity"]),
        homed_axes=homed_axes.upper(),
        ahead_s=_number(toolhead["print_time"]) - _number(toolhead["estimated_print_time"]),
    )


def _place(values: Any) -> Place:
    if not isinstance(values, list) or len(values) < 3:
        raise ValueError(values)
    place = tuple(map(_number, values[:3]))
    if not all(abs(each) < FARTHEST_MM for each in place):
        raise ValueError(values)
    return place


def _number(value: Any) -> float:
    if type(value) not in (int, float) or not math.isfinite(value):
        raise ValueError(value)
    return float(value)
