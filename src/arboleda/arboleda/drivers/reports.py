"""Checks that an object from a driver is a report that one of its devices can have made."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from typing import Any

from arboleda.model.messages import MotionState, Receipt, Report, Tokens
from arboleda.model.outside import plain, quoted
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import Sentence

LONGEST = 200  # characters of a word
LARGEST = sys.float_info.max
PAIRS = (("rejected", "refusal"), ("failed", "failure"), ("answered", "answer"))


def objection(report: object, devices: Mapping[str, Robot]) -> str | None:
    """The reason why this is no report of one of these devices; None if it is one."""
    if not isinstance(report, Report):
        return f"{quoted(report)} is no Report"
    if report.robot not in devices:
        return f"{quoted(report.robot)} is none of its devices ({', '.join(devices)})"
    for name, (fits, what) in FIELDS.items():
        value = getattr(report, name)
        if value is not None and not fits(value):
            return f"{name} of {report.robot} is {quoted(value)}; it must be {what}"
    if not is_number(report.at):
        return f"at of {report.robot} is {quoted(report.at)}; it must be what the clock said"
    for id, word in PAIRS:
        if (getattr(report, id) is None) != (getattr(report, word) is None):
            return f"{id} and {word} of {report.robot} go together"
    found = devices[report.robot].objection(report)
    return None if found is None else plain(found)


def is_number(value: object) -> bool:
    """True if it is a number that a float can be; a whole number may have any number of digits."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST


def _is_count(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_text(value: object) -> bool:
    return isinstance(value, str) and len(value) <= LONGEST


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_value(value: object) -> bool:
    return isinstance(value, bool) or is_number(value) or (isinstance(value, str) and len(value) <= LONGEST)


def _are_facts(value: Any) -> bool:
    pairs = isinstance(value, tuple) and all(isinstance(each, tuple) and len(each) == 2 for each in value)
    return pairs and all(isinstance(name, str) and _is_value(each) for name, each in value)


def _are_names(value: object) -> bool:
    return isinstance(value, tuple) and all(map(_is_text, value))


def _is_position(value: object) -> bool:
    return isinstance(value, tuple) and all(map(is_number, value))


def _is_receipt(value: object) -> bool:
    if not isinstance(value, Receipt):
        return False
    return all(map(_is_count, value[:2])) and (value.done is None or _is_count(value.done))


def _are_tokens(value: object) -> bool:
    return isinstance(value, Tokens) and all(each is None or _is_text(each) for each in value)


TEXT = (_is_text, "a word or an id")
FLAG = (_is_flag, "True or False")
COUNT = (_is_count, "a whole number of 0 or more")
FIELDS: dict[str, tuple[Callable[[Any], bool], str]] = {
    **dict.fromkeys(("accepted", "done", "rejected", "refusal", "failed", "failure", "answered"), TEXT),
    **dict.fromkeys(("homed", "effector", "piece"), FLAG),
    **dict.fromkeys(("boot_id", "node"), COUNT),
    "answer": (_is_value, "a word, a number, True or False"),
    "state": (lambda value: isinstance(value, MotionState), "a MotionState"),
    "q": (_is_position, "a tuple of numbers"),
    "facts": (_are_facts, 'a tuple of pairs, (("door", "open"),)'),
    "unknown": (_are_names, 'a tuple of names of facts, ("door",)'),
    "receipt": (_is_receipt, "a Receipt of whole numbers of 0 or more"),
    "tokens": (_are_tokens, "Tokens, as commands carried them"),
    "lost": (lambda value: isinstance(value, Sentence), "a Sentence, as lost() makes it"),
}
"""The check of each field of a report, and the allowed values in words."""
