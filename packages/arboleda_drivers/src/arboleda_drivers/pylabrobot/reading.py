"""Values that a machine shows, as the words and numbers of a kind of device."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from arboleda.drivers import DriverError, FactType, Value, quoted

from .paths import steps

SCALARS = (bool, int, float, str)
LARGEST = 2**63


class UnreadableValue(DriverError):
    """Value of a machine that has no meaning in the mapping."""


@dataclass(frozen=True, kw_only=True)
class Reading:
    """Path to a value, and what the value means.

    `words` are values by their words, each one value or its least and greatest; `near`, how far a number may
    be from one that the kind names; `otherwise`, the word for anything else. `counted`: PyLabRobot counts it
    by what was ordered, and does not ask the machine; by default where nothing is called on the path.
    """

    read: str = ""
    words: dict[str, Any] = field(default_factory=dict)
    near: float = 0.0
    otherwise: bool | int | float | str | None = None
    counted: bool | None = None

    @property
    def is_counted(self) -> bool:
        """True for a value of which only PyLabRobot's own count is read."""
        return "()" not in self.read if self.counted is None else self.counted

    def __post_init__(self) -> None:
        steps(self.read)
        if not 0 <= self.near < math.inf:
            raise DriverError(f"near is {self.near:g}; allowed: 0 or more")
        for word, meant in self.words.items():
            if isinstance(meant, list | tuple):
                if len(meant) != 2 or not all(map(_is_number, meant)) or meant[0] > meant[1]:
                    raise DriverError(f"{word} needs its least and its greatest value, [10, 20]")
            elif not isinstance(meant, SCALARS):
                raise DriverError(f"{word} needs a value, or its least and its greatest, [10, 20]")

    def value(self, raw: object, of: FactType) -> Value:
        """The value read, as that type; raises UnreadableValue if it has no meaning there."""
        if isinstance(raw, Enum):
            raw = raw.value
        if isinstance(raw, str) or not isinstance(raw, SCALARS) or _is_number(raw) or isinstance(raw, bool):
            for meant in self._meanings(raw, of):
                found = of.read(meant)
                if found is not None:
                    return found
        where = self.read or "the result"
        raise UnreadableValue(f"{where} is {_shown(raw)}; allowed: {of.allowed()}")

    def problem(self, of: FactType) -> str:
        """The sentence on what does not fit a fact of that type; "" if all does."""
        for word in [*self.words, *([] if self.otherwise is None else [self.otherwise])]:
            if of.read(word) is None:
                return f"{quoted(word)} is none of its values; allowed: {of.allowed()}"
        if self.near and of.type not in (int, float):
            return f"near is for numbers, and the value is {of.allowed()}"
        return ""

    def _meanings(self, raw: object, of: FactType) -> Iterator[object]:
        """The meanings that the value may have, the likeliest first."""
        if self.words:
            yield from (word for word, meant in self.words.items() if _is_meant(raw, meant))
        elif of.type is bool and not isinstance(raw, SCALARS):
            yield raw is not None  # a plate that is there, or none
        elif self.near and _is_number(raw):
            yield self._nearest(float(raw), of)  # type: ignore[arg-type]
        else:
            yield raw
        yield self.otherwise

    def _nearest(self, raw: float, of: FactType) -> object:
        numbers = [word for word in of.words if _is_number(word) and abs(float(word) - raw) <= self.near]
        if of.words:
            return min(numbers, key=lambda word: abs(float(word) - raw), default=None)
        return round(raw) if of.type is int else round(raw / self.near) * self.near


def _is_number(value: object) -> bool:
    """True for a number that a report may have."""
    return isinstance(value, int | float) and not isinstance(value, bool) and -LARGEST < value < LARGEST


def _is_meant(raw: object, meant: Any) -> bool:
    if isinstance(meant, list | tuple):
        return _is_number(raw) and meant[0] <= raw <= meant[1]
    return (
        isinstance(raw, bool) == isinstance(meant, bool) and isinstance(raw, SCALARS) and bool(raw == meant)
    )


def _shown(raw: object) -> str:
    if isinstance(raw, int) and not -LARGEST < raw < LARGEST:
        return "too large a number"
    return quoted(raw) if isinstance(raw, SCALARS) or raw is None else f"of the type {type(raw).__name__}"
