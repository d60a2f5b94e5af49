"""Variables, arguments and methods of a server, and conversion of their values."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers.port import DriverError
from arboleda.kinds.declared import FactType
from arboleda.model.facts import Value
from arboleda.model.outside import quoted

from ..plc.plc_snapshot import UnreadableValue

NODE = re.compile(r"(ns=\d+;)?(i=\d+|s=.+|g=[0-9a-fA-F-]{36}|b=.+)")
Form = Literal[
    "bool",
    "sbyte",
    "byte",
    "int16",
    "uint16",
    "int32",
    "uint32",
    "int64",
    "uint64",
    "float",
    "double",
    "string",
]
BITS = {"sbyte": 8, "int16": 16, "int32": 32, "int64": 64}
UNSIGNED_BITS = {"byte": 8, "uint16": 16, "uint32": 32, "uint64": 64}
LIMITS = {name: (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for name, bits in BITS.items()}
LIMITS |= {name: (0, 2**bits - 1) for name, bits in UNSIGNED_BITS.items()}
FORMS: dict[type, tuple[str, ...]] = {
    bool: ("bool",),
    int: tuple(LIMITS),
    float: ("float", "double"),
    str: ("string",),
}


def check_node(node: str) -> None:
    """Raises DriverError if a text is no id of a node."""
    if not NODE.fullmatch(node):
        raise DriverError(f"{quoted(node)} is no node; write it as ns=2;s=Belt.State or ns=2;i=1001")


def check_words(words: dict[str, int]) -> None:
    """Raises DriverError if two words have the same number."""
    if len(set(words.values())) < len(words):
        raise DriverError("two words have the same number")


@dataclass(frozen=True, kw_only=True)
class Variable:
    """Variable of the server; `words` are its numbers, if they stand for words."""

    node: str
    words: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_node(self.node)
        check_words(self.words)

    def word(self, shown: object) -> object:
        """The word for the value read, if there are words; UnreadableValue for a number without one."""
        if not self.words:
            return shown
        found = next((word for word, held in self.words.items() if is_whole(shown) and held == shown), None)
        if found is None:
            known = ", ".join(self.words)
            raise UnreadableValue(f"{self.node} is {quoted(shown)}, for which there is no word ({known})")
        return found

    def read(self, shown: object, of: FactType) -> Value:
        """The value read, as that type; raises UnreadableValue if it is none."""
        word = self.word(shown)
        finite = not isinstance(word, float) or math.isfinite(word)
        found = of.read(word) if finite else None
        if found is None:
            raise UnreadableValue(f"{self.node} is {quoted(shown)}; allowed: {of.allowed()}")
        return found


@dataclass(frozen=True, kw_only=True)
class Argument:
    """Argument of a method: a value, or `$name` for the verb's parameter, and its type in OPC UA."""

    value: bool | int | float | str
    type: Form
    words: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_words(self.words)
        if self.words and self.type not in LIMITS:
            raise DriverError(f"words are numbers, and the type is {self.type}; allowed: {', '.join(LIMITS)}")
        for word, number in self.words.items():
            if not self.fits(number):
                raise DriverError(f"{word}: {number} is no {self.type}")
        if self.parameter is None:
            self.given(self.value)

    @property
    def parameter(self) -> str | None:
        value = self.value
        return value[1:] if isinstance(value, str) and value.startswith("$") else None

    def fits(self, value: Value) -> bool:
        """True if a value is of the type of the argument, and within its limits."""
        if self.type in LIMITS:
            low, high = LIMITS[self.type]
            return is_whole(value) and low <= float(value) <= high
        if self.type in FORMS[float]:
            return isinstance(value, int | float) and not isinstance(value, bool)
        return isinstance(value, bool if self.type == "bool" else str)

    def given(self, value: Value) -> Value:
        """The value to pass; raises DriverError if it does not fit."""
        number = self.words.get(value, value) if isinstance(value, str) else value
        if not self.fits(number):
            raise DriverError(f"{quoted(value)} is no {self.type}")
        return float(number) if self.type in FORMS[float] else number


@dataclass(frozen=True, kw_only=True)
class Method:
    """Method, the object that it belongs to, and its arguments in order."""

    call: str
    on: str
    given: tuple[Argument, ...] = ()

    def __post_init__(self) -> None:
        check_node(self.call)
        check_node(self.on)


def is_whole(value: object) -> bool:
    """True for a whole number; a bool is none."""
    return isinstance(value, int) and not isinstance(value, bool)


def number(node: str, shown: object) -> int:
    """The whole number of 0 or more that a node shows; raises UnreadableValue for anything else."""
    if not isinstance(shown, int) or isinstance(shown, bool) or shown < 0:
        raise UnreadableValue(f"{node} is {quoted(shown)}; allowed: a whole number from 0")
    return shown
