"""Values of attributes: a constant, or the name of a variable whose value is meant."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

INT = re.compile(r"[+-]?[0-9]{1,18}|0[xX][0-9a-fA-F]{1,15}")
BOOLS = ("true", "false", "True", "False", "TRUE", "FALSE", "0", "1")
STATUSES = ("SUCCESS", "FAILURE", "RUNNING", "SKIPPED", "IDLE")
OUTER = "@"  # begins the name of a variable of the outermost tree
PRIVATE = "_"  # begins the name of a variable that no other tree shares


@dataclass(frozen=True)
class Variable:
    """Reference to a variable: `{goal}`, or `{@goal}` of the outermost tree."""

    name: str


AttributeValue = str | Variable


def read(attribute: str, text: str) -> AttributeValue:
    """The constant or variable that an attribute holds; `{=}` is the variable with the attribute's own name.

    Text with a variable in it, `to {goal}`, is text: BehaviorTree.CPP puts no value in there.
    """
    inner = text.strip()
    if not (inner.startswith("{") and inner.endswith("}")) or len(inner) < 3:
        return text
    name = inner[1:-1].strip()
    return Variable(attribute if name == "=" else name)


def objection(type: str, text: str) -> str | None:
    """The reason why a text is no value of a type; None if it is one, or the type is unknown here."""
    described = TYPES.get(type)
    if described is None or described[1](text.strip()):
        return None
    return described[0]


def fits(given: str, taken: str) -> bool:
    """True if every value of type `given` is a value of type `taken`, or if either type is unknown."""
    if given not in TYPES or taken not in TYPES or given == taken:
        return True
    return given in WHOLE and taken in NUMBERS


def number(text: str) -> float:
    """The number that a text means for a type of numbers."""
    return float(int(text, 16)) if "x" in text.lower() else float(text)


def plain_type(type: str | None) -> str:
    """The name of a type in this table, however a model spells it; "" for any other."""
    name = SPELLINGS.get((type or "").strip(), (type or "").strip())
    return name if name in TYPES else ""


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
