"""A Report as `/{robot}/status` carries it over ROS 2.

The values are strings: integers in decimal, `q` in rad or m separated by commas, flags as true or false,
facts and answers of devices as JSON. A field that the robot did not report has no key. Unknown keys are
allowed.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from arboleda.model.errors import PayloadError
from arboleda.model.facts import Facts, Value
from arboleda.model.messages import MotionState, Receipt, Report, Tokens
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import OWN, Sentence, from_data

from . import strict
from .board import DENIED
from .rejections import FOREIGN_PHRASES
from .strict import UINT32

OK, WARN, ERROR, STALE = range(4)  # levels of diagnostic_msgs/DiagnosticStatus
NUMBER = "number"  # the last key of a status, except for those on foreign commands
NUMBER_DIGITS = len(str(UINT32))
_FLOAT = re.compile(r"-?\d+(\.\d+)?([eE][-+]?\d+)?", re.ASCII)
_ID = re.compile(r"[A-Za-z0-9_.-]{1,64}", re.ASCII)
_COUNT = re.compile(r"\d{1,10}", re.ASCII)
_LONGEST = 300  # characters of a sentence
_MOST_DATA = 2000  # characters of the data of a sentence
PARTS = "_said"  # ends the key for the data of a sentence
_SENTENCES = {"foreign": FOREIGN_PHRASES, "lost": {DENIED.key: DENIED}}  # phrases by key of the status
_FLAGS = {"true": True, "false": False}
_LEVELS = {
    MotionState.STOPPED: (OK, "stopped"),
    MotionState.MOVING: (OK, "moving"),
    MotionState.FAULT: (ERROR, "fault"),
    MotionState.NOT_HOMED: (WARN, "not homed"),
    MotionState.STOP_LATCHED: (WARN, "stop latched"),
    MotionState.NO_LINK: (STALE, "no link"),
}


@dataclass(frozen=True, kw_only=True)
class Status:
    """Plain content of a DiagnosticStatus; `level` is one of OK, WARN, ERROR, STALE."""

    name: str
    hardware_id: str
    level: int
    message: str
    values: dict[str, str]


def to_status(robot: Robot, report: Report) -> Status:
    """The status to publish for a report; a report without a state is on refused or foreign commands."""
    level, message = (WARN, "command refused") if report.state is None else _LEVELS[report.state]
    rows = [(key, getattr(report, name), write) for key, (name, _, write) in _ROWS.items()]
    values = {key: write(value) for key, value, write in rows if value is not None}
    for key in _SENTENCES:
        if (sentence := getattr(report, key)) is not None:
            values |= _written(key, sentence)
    return Status(name=_name(robot), hardware_id=robot.mqtt, level=level, message=message, values=values)


def from_status(at: float, robot: Robot, status: Status) -> Report:
    """The report in a status received `at`; raises PayloadError, which names the wrong key."""
    if status.name != _name(robot):
        raise PayloadError(f"status name is {quoted(status.name)}; allowed: {quoted(_name(robot), 80)}")
    row = {
        name: read(key, status.values[key]) for key, (name, read, _) in _ROWS.items() if key in status.values
    }
    row |= {key: _said(key, status.values) for key in _SENTENCES}
    report = Report(at=at, robot=robot.name, **row)  # type: ignore[arg-type]
    _fits(robot, report)
    return report


def _name(robot: Robot) -> str:
    return f"arboleda: {robot.name}"


def _fits(robot: Robot, report: Report) -> None:
    if (objection := robot.objection(report)) is not None:
        raise PayloadError(objection)
    if (report.rejected is None) != (report.refusal is None):
        raise PayloadError("rejected and reason go together")
    if (report.failed is None) != (report.failure is None):
        raise PayloadError("failed and failure go together")
    if (report.answered is None) != (report.answer is None):
        raise PayloadError("answered and answer go together")


def command_id(key: str, text: str) -> str:
    """The id, if it is valid; raises PayloadError otherwise."""
    if not _ID.fullmatch(text):
        raise PayloadError(f"{key} is {quoted(text)}; 1 to 64 of A-Z a-z 0-9 _ . - are needed")
    return text


def _sentence(key: str, text: str) -> str:
    if not 1 <= len(text) <= _LONGEST or not text.isprintable():
        raise PayloadError(f"{key} is {text[:40]!a}; 1 to {_LONGEST} printable characters are needed")
    return text


def _written(key: str, sentence: Sentence) -> dict[str, str]:
    return {key: str(sentence), f"{key}{PARTS}": json.dumps(sentence.data())}


def _said(key: str, values: Mapping[str, str]) -> Sentence | None:
    """A sentence of the status, with its parts; only its text if the parts give another text."""
    if key not in values:
        return None
    text, parts = _sentence(key, values[key]), values.get(f"{key}{PARTS}", "")
    try:
        made = from_data(json.loads(parts), _SENTENCES[key]) if len(parts) <= _MOST_DATA else None
        if str(made) == text and made is not None:
            return made
    except (ValueError, LookupError, RecursionError):  # as an older bridge, or somebody else, writes it
        pass
    return OWN(text=text)


def count(key: str, text: str) -> int:
    """The number, if it is valid; raises PayloadError otherwise."""
    if not _COUNT.fullmatch(text) or int(text) > UINT32:
        raise PayloadError(f"{key} is {quoted(text)}; an integer of 0 to {UINT32} is needed")
    return int(text)


def _state(key: str, text: str) -> MotionState:
    try:
        return MotionState(count(key, text))
    except ValueError:
        allowed = ", ".join(str(state.value) for state in MotionState)
        raise PayloadError(f"{key} is {quoted(text)}; allowed: {allowed}") from None


def _joints(key: str, text: str) -> tuple[float, ...]:
    parts = text.split(",")
    if not all(_FLOAT.fullmatch(part) and math.isfinite(float(part)) for part in parts):
        raise PayloadError(f"{key} is {quoted(text)}; finite numbers separated by commas are needed")
    return tuple(float(part) for part in parts)


def _flag(key: str, text: str) -> bool:
    if text not in _FLAGS:
        raise PayloadError(f"{key} is {quoted(text)}; allowed: true, false")
    return _FLAGS[text]


def _word(key: str, text: str) -> str:
    return strict.name(key, text, strict.LONGEST_WORD)


def _answer(key: str, text: str) -> Value:
    return strict.shown_fact(key, _in_json(key, text))


def _facts(key: str, text: str) -> Facts:
    return strict.facts(key, _in_json(key, text), strict.shown_fact)


def _in_json(key: str, text: str) -> object:
    """The value of a JSON text, which is limited to the length of a device's message."""
    try:
        return strict.parse(text.encode())
    except PayloadError as error:
        raise PayloadError(f"{key}: {error}") from None


def _receipt(key: str, text: str) -> Receipt:
    epoch, accepted, *done = text.split(",")[:3] if text.count(",") in (1, 2) else ("", "")
    return Receipt(count(key, epoch), count(key, accepted), count(key, done[0]) if done else None)


def token(text: str) -> str:
    """The token, if it is valid; raises PayloadError otherwise."""
    return strict.name("token", text, strict.LONGEST_TOKEN)


def _tokens(key: str, text: str) -> Tokens:
    accepted, _, done = text.partition(",")
    return Tokens(*[token(each) if each else None for each in (accepted, done)])


def _write_tokens(tokens: Tokens) -> str:
    return ",".join(each or "" for each in tokens)


def _write_receipt(receipt: Receipt) -> str:
    return ",".join(str(number) for number in receipt if number is not None)


def _write_facts(facts: Facts) -> str:
    return strict.to_json(dict(facts))


def written_number(number: int) -> str:
    """The number of telemetry, padded to full length, so that statuses at rest differ in nothing else."""
    return f"{number:0{NUMBER_DIGITS}d}"


def _write_state(state: MotionState) -> str:
    return str(state.value)


def _write_joints(q: tuple[float, ...]) -> str:
    return ",".join(repr(float(value)) for value in q)


def _write_flag(value: bool) -> str:
    return "true" if value else "false"


_ROWS: dict[str, tuple[str, Callable[[str, str], object], Callable[..., str]]] = {
    "epoch": ("epoch", count, str),
    "plant": ("plant", count, str),
    "boot_id": ("boot_id", count, str),
    "accepted": ("accepted", command_id, str),
    "done": ("done", command_id, str),
    "rejected": ("rejected", command_id, str),
    "reason": ("refusal", command_id, str),
    "failed": ("failed", command_id, str),
    "failure": ("failure", _word, str),
    "answered": ("answered", command_id, str),
    "answer": ("answer", _answer, strict.to_json),
    "state": ("state", _state, _write_state),
    "q": ("q", _joints, _write_joints),
    "node": ("node", count, str),
    "homed": ("homed", _flag, _write_flag),
    "effector": ("effector", _flag, _write_flag),
    "piece": ("piece", _flag, _write_flag),
    "facts": ("facts", _facts, _write_facts),
    "receipt": ("receipt", _receipt, _write_receipt),
    "tokens": ("tokens", _tokens, _write_tokens),
    "foreign_refused": ("foreign_refused", count, str),
    "foreign_obeyed": ("foreign_obeyed", count, str),
    NUMBER: ("number", count, written_number),
}
"""Key of the status -> (field of the Report, how it is read, how it is written)."""
