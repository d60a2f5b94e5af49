"""What stands in an attribute: a value as such, or the name of a variable whose value is meant."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

INT = re.compile(r"[+-]?[0-9]{1,18}|0[xX][0-9a-fA-F]{1,15}")
BOOLS = ("true", "false", "True", "False", "TRUE", "FALSE", "0", "1")
STATUSES = ("SUCCESS", "FAILURE", "RUNNING", "SKIPPED", "IDLE")
OUTER = "@"  # begins the name of a variable of the outermost tree
PRIVATE = "_"  # begins the name of one that no other tree shares


@dataclass(frozen=True)
class Variable:
    """`{goal}`, or `{@goal}` of the outermost tree."""

    name: str


Said = str | Variable


def read(attribute: str, text: str) -> Said:
    """What an attribute says; `{=}` is the variable that is called like the attribute.

    Text with a variable in it, `to {goal}`, is text: BehaviorTree.CPP puts no value in there.
    """
    inner = text.strip()
    if not (inner.startswith("{") and inner.endswith("}")) or len(inner) < 3:
        return text
    name = inner[1:-1].strip()
    return Variable(attribute if name == "=" else name)


def objection(type: str, text: str) -> str | None:
    """Why a text is no value of a type; None where it is one, or nobody here knows the type."""
    known = TYPES.get(type)
    if known is None or known[1](text.strip()):
        return None
    return known[0]


def fits(given: str, taken: str) -> bool:
    """Whether every value of a type is one of another; of types that nobody here knows it is."""
    if given not in TYPES or taken not in TYPES or given == taken:
        return True
    return given in WHOLE and taken in NUMBERS


def number(text: str) -> float:
    """The number that a text of a type of numbers spells."""
    return float(int(text, 16)) if "x" in text.lower() else float(text)


def plain_type(type: str | None) -> str:
    """A type as this table calls it, however a model spells it; "" for any other."""
    found = SPELLINGS.get((type or "").strip(), (type or "").strip())
    return found if found in TYPES else ""


def _is_float(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text


def _is_unsigned(text: str) -> bool:
    return INT.fullmatch(text) is not None and not text.startswith("-")


TYPES: Mapping[str, tuple[str, Callable[[str], bool]]] = {
    "int": ("a whole number", lambda text: INT.fullmatch(text) is not None),
    "unsigned": ("a whole number that is not negative", _is_unsigned),
    "msec": ("a whole number of milliseconds", _is_unsigned),
    "double": ("a number", _is_float),
    "bool": ("true or false", lambda text: text in BOOLS),
    "status": (" or ".join(STATUSES[:4]), lambda text: text in STATUSES),
}
WHOLE = ("int", "unsigned", "msec")
NUMBERS = (*WHOLE, "double")
SPELLINGS = {
    "unsigned int": "unsigned",
    "unsigned long": "unsigned",
    "long": "int",
    "int32_t": "int",
    "int64_t": "int",
    "uint32_t": "unsigned",
    "uint64_t": "unsigned",
    "float": "double",
    "std::chrono::milliseconds": "msec",
    "BT::NodeStatus": "status",
    "NodeStatus": "status",
}
