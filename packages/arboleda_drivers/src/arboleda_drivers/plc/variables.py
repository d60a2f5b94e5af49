"""Variable of a PLC by its place, its words, and what the values read there must be."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers import DriverError, FactType, Value, quoted

from .plc_snapshot import UnreadableValue

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
LIMITS: dict[str, tuple[int, int]] = {
    name: (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for name, bits in BITS.items()
}
LIMITS |= {name: (0, 2**bits - 1) for name, bits in UNSIGNED_BITS.items()}
FORMS: dict[type, tuple[str, ...]] = {
    bool: ("bool",),
    int: tuple(LIMITS),
    float: ("float", "double"),
    str: ("string",),
}


def check_words(words: dict[str, int]) -> None:
    """Raises DriverError if two words have the same number."""
    if len(set(words.values())) < len(words):
        raise DriverError("two words have the same number")


@dataclass(frozen=True, kw_only=True)
class PlcVariable(ABC):
    """Variable of a PLC; `words` are its numbers, if they stand for words."""

    words: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_words(self.words)

    @property
    @abstractmethod
    def place(self) -> str:
        """The name of the place where it stands, as the plant file has it."""

    def word(self, shown: object) -> object:
        """The word for the value read, if there are words; UnreadableValue for a number without one."""
        if not self.words:
            return shown
        found = next((word for word, held in self.words.items() if is_whole(shown) and held == shown), None)
        if found is None:
            known = ", ".join(self.words)
            raise UnreadableValue(f"{self.place} is {quoted(shown)}, for which there is no word ({known})")
        return found

    def read(self, shown: object, of: FactType) -> Value:
        """The value read, as that type; raises UnreadableValue if it is none."""
        word = self.word(shown)
        finite = not isinstance(word, float) or math.isfinite(word)
        found = of.read(word) if finite else None
        if found is None:
            raise UnreadableValue(f"{self.place} is {quoted(shown)}; allowed: {of.allowed()}")
        return found


@dataclass(frozen=True, kw_only=True)
class PlcArgument(ABC):
    """Value that is sent to a PLC, or `$name` for the verb's parameter; `words` are its numbers."""

    value: bool | int | float | str
    words: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_words(self.words)
        if self.words and self.form not in (*LIMITS, *FORMS[bool]):
            what = f"words are numbers, and the type is {self.type_name}"
            raise DriverError(f"{what}; write a type of integers or bits")
        for word, number in self.words.items():
            if not (number in (0, 1) if self.form == "bool" else self.fits(number)):
                raise DriverError(f"{word}: {number} is no {self.type_name}")
        if self.parameter is None:
            self.given(self.value)

    @property
    @abstractmethod
    def form(self) -> Form:
        """Its type."""

    @property
    @abstractmethod
    def type_name(self) -> str:
        """The name of its type, as people of that protocol write it."""

    @property
    def parameter(self) -> str | None:
        """The parameter that it names; None for a plain value."""
        value = self.value
        return value[1:] if isinstance(value, str) and value.startswith("$") else None

    def fits(self, value: Value) -> bool:
        """True if a value is of the type of the argument, and within its limits."""
        if self.form in LIMITS:
            low, high = LIMITS[self.form]
            return is_whole(value) and low <= float(value) <= high
        if self.form in FORMS[float]:
            return isinstance(value, int | float) and not isinstance(value, bool)
        return isinstance(value, bool if self.form == "bool" else str)

    def given(self, value: Value) -> Value:
        """The value to send; raises DriverError if it does not fit."""
        number = self.words.get(value, value) if isinstance(value, str) else value
        if self.form == "bool" and value in self.words:
            number = bool(number)
        if not self.fits(number):
            raise DriverError(f"{quoted(value)} is no {self.type_name}")
        return float(number) if self.form in FORMS[float] else number

    def filled(self, values: Mapping[str, Value]) -> Value:
        """The value to send for a verb with these values of its parameters."""
        return self.given(self.value if self.parameter is None else values[self.parameter])


def is_whole(value: object) -> bool:
    """True for a whole number; a bool is none."""
    return isinstance(value, int) and not isinstance(value, bool)


def count(place: str, shown: object, *, floats: bool = False) -> int:
    """The whole number of 0 or more that a place shows; raises UnreadableValue for anything else.

    `floats`: a whole number may be shown as a float.
    """
    if floats and isinstance(shown, float) and shown.is_integer():
        shown = int(shown)
    if not isinstance(shown, int) or isinstance(shown, bool) or shown < 0:
        raise UnreadableValue(f"{place} is {quoted(shown)}; allowed: a whole number from 0")
    return shown


def yes(place: str, shown: object) -> bool:
    """The bool that a place shows; raises UnreadableValue for anything else."""
    if not isinstance(shown, bool):
        raise UnreadableValue(f"{place} is {quoted(shown)}; allowed: true or false")
    return shown
