"""Meaning of values that a device shows, as the words and numbers of its kind."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from arboleda.drivers import DriverError, FactType, Value, quoted

SCALARS = (bool, int, float, str)
LARGEST = 2**63
TRUTH = {"true": True, "false": False}
ROUNDING = 1e-9  # share by which a number that was scaled may be off


class UnreadableValue(DriverError):
    """Value of a device that has no meaning in the mapping."""


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """Meaning of a value that a device shows.

    `words` are values by their words, each one value, its least and greatest, or several texts. `scale` is
    what a number is multiplied by; `near`, how far a number may be from one that the kind names, and else the
    step to which it is rounded; `otherwise`, the word for anything else.
    """

    words: dict[str, Any] = field(default_factory=dict)
    scale: float = 1.0
    near: float = 0.0
    otherwise: bool | int | float | str | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.near < math.inf:
            raise DriverError(f"near is {self.near:g}; allowed: 0 or more")
        if not math.isfinite(self.scale) or self.scale == 0:
            raise DriverError(f"scale is {self.scale:g}; allowed: any number but 0")
        for word, meant in self.words.items():
            if isinstance(meant, list | tuple):
                if not is_range(meant) and not (meant and all(isinstance(each, str) for each in meant)):
                    raise DriverError(f"{word} needs its least and its greatest value, [10, 20]")
            elif not isinstance(meant, SCALARS):
                raise DriverError(f"{word} needs a value, or its least and its greatest, [10, 20]")

    def value(self, raw: object, of: FactType, where: str) -> Value:
        """The value shown, as that type; raises UnreadableValue if it has no meaning there.

        `where` is its place, for the sentence.
        """
        if isinstance(raw, Enum):
            raw = raw.value
        if isinstance(raw, str) or not isinstance(raw, SCALARS) or is_number(raw) or isinstance(raw, bool):
            for meant in self._meanings(raw, of):
                found = _said(meant, of)
                if found is not None:
                    return found
        raise UnreadableValue(f"{where} is {_shown(raw)}; allowed: {of.allowed()}")

    def word(self, raw: object) -> str | None:
        """The word for a value; None where it has none."""
        return next((word for word, meant in self.words.items() if is_meant(raw, meant)), None)

    def shown(self, value: Value) -> object:
        """A value that means this one: the opposite of `value`."""
        for word, meant in self.words.items():
            if as_text(word) == as_text(value):
                return meant[0] if isinstance(meant, list | tuple) else meant
        return value if self.scale == 1 or not is_number(value) else float(value) / self.scale

    def problem(self, of: FactType) -> str:
        """The sentence on what does not fit a fact of that type; "" if all does."""
        for word in [*self.words, *([] if self.otherwise is None else [self.otherwise])]:
            if _said(word, of) is None:
                return f"{quoted(word)} is none of its values; allowed: {of.allowed()}"
        for key, is_said in (("near", self.near), ("scale", self.scale != 1)):
            if is_said and of.type not in (int, float):
                return f"{key} is for numbers, and the value is {of.allowed()}"
        return ""

    def _meanings(self, raw: object, of: FactType) -> Iterator[object]:
        """The meanings that the value may have, the likeliest first."""
        if self.words:
            yield from (word for word, meant in self.words.items() if is_meant(raw, meant))
        elif of.type is bool and not isinstance(raw, SCALARS):
            yield raw is not None  # a plate that is there, or none
        elif is_number(raw) and (self.near or self.scale != 1):
            yield self._nearest(float(raw) * self.scale, of)  # type: ignore[arg-type]
        else:
            yield raw
        yield self.otherwise

    def _nearest(self, number: float, of: FactType) -> object:
        if of.words:
            near = max(self.near, abs(number) * ROUNDING)
            words = [word for word in of.words if is_number(word) and abs(float(word) - number) <= near]
            return min(words, key=lambda word: abs(float(word) - number), default=None)
        stepped = round(number / self.near) * self.near if self.near and of.type is float else number
        return round(stepped) if of.type is int else stepped


def _said(word: object, of: FactType) -> Value | None:
    """The value of that type; a bool may be named by a word of the file, `{true: ON}`."""
    return of.read(TRUTH.get(word, word) if of.type is bool and isinstance(word, str) else word)


def is_number(value: object) -> bool:
    """True for a number that a report may have."""
    return isinstance(value, int | float) and not isinstance(value, bool) and -LARGEST < value < LARGEST


def is_range(meant: Any) -> bool:
    """True for the least and the greatest value."""
    return len(meant) == 2 and all(map(is_number, meant)) and bool(meant[0] <= meant[1])


def is_meant(raw: object, meant: Any) -> bool:
    """True for a value that is the one meant, one of several texts, or between the least and the greatest.

    A number or a bool may be written as text.
    """
    if isinstance(meant, list | tuple):
        return bool(is_number(raw) and meant[0] <= raw <= meant[1]) if is_range(meant) else raw in meant
    if not isinstance(raw, SCALARS):
        return False
    if isinstance(raw, str) or isinstance(meant, str):
        return as_text(raw) == as_text(meant)
    return isinstance(raw, bool) == isinstance(meant, bool) and bool(raw == meant)


def as_text(value: object) -> str:
    """A value as devices write it: true and false in small letters, whole numbers without a point."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def in_words(meant: Any) -> str:
    """The meaning of a word, for people: a value, the least and the greatest, or several texts."""
    if not isinstance(meant, list | tuple):
        return as_text(meant)
    return (" to " if is_range(meant) else " or ").join(map(as_text, meant))


def _shown(raw: object) -> str:
    if isinstance(raw, int) and not -LARGEST < raw < LARGEST:
        return "too large a number"
    return quoted(raw) if isinstance(raw, SCALARS) or raw is None else f"of the type {type(raw).__name__}"
