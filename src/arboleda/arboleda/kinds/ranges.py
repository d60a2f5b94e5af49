"""Comparisons of numbers, as recipes, trees and plant files write them: "> 120", ">= 120 and < 150"."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

from arboleda.model.facts import Value
from arboleda.model.outside import quoted

from .declared import DeviceKind, FactType, UseError

FORMS = "'> 120', '<= 120' or '>= 120 and < 150'"
NUMBERS = (int, float)
COMPARISON = re.compile(r"\s*([<>]=?)\s*([+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*")


@dataclass(frozen=True, kw_only=True)
class Range:
    """The numbers for which a comparison is true, as it is written in `text`; no number of `others` is."""

    text: str
    lower: float = -math.inf
    upper: float = math.inf
    has_lower: bool = False
    has_upper: bool = False
    others: tuple[Range, ...] = ()

    def __str__(self) -> str:
        return self.text

    def has(self, value: object) -> bool:
        if isinstance(value, bool) or not isinstance(value, int | float):
            return False
        is_above = value > self.lower or (self.has_lower and value == self.lower)
        is_below = value < self.upper or (self.has_upper and value == self.upper)
        return is_above and is_below and not any(each.has(value) for each in self.others)


Wanted = Value | Range
"""Value that a fact or an answer has to be, or range in which it has to lie."""


def is_so(wanted: Wanted, told: Value | None) -> bool:
    """True if what was told is what is wanted; what was never told is nothing."""
    return wanted.has(told) if isinstance(wanted, Range) else told == wanted


def spelled(number: float) -> str:
    """A number as it is written in a comparison."""
    return f"{number:.12g}"


def exactly(number: float) -> Range:
    """The range of one number."""
    return Range(text=spelled(number), lower=number, upper=number, has_lower=True, has_upper=True)


def comparison(text: str) -> Range | None:
    """The range that a comparison says; None for a text that is none."""
    limits: dict[str, tuple[float, bool]] = {}
    for part in text.split(" and "):
        match = COMPARISON.fullmatch(part)
        if match is None or match[1][0] in limits:
            return None
        limits[match[1][0]] = float(match[2]), match[1].endswith("=")
    lower, has_lower = limits.get(">", (-math.inf, False))
    upper, has_upper = limits.get("<", (math.inf, False))
    return Range(
        text=" ".join(text.split()), lower=lower, upper=upper, has_lower=has_lower, has_upper=has_upper
    )


def fact_wanted(kind: DeviceKind, name: str, value: Value) -> Wanted:
    """The value or the range that a fact has to have; UseError where no device of the kind reports that."""
    type = kind.facts.get(name)
    compared = comparison(value) if isinstance(value, str) else None
    if type is None or compared is None or type.takes(value):
        kind.check_fact(name, value)
        return value
    if type.type not in NUMBERS:
        allowed = type.allowed()
        raise UseError(
            f"{name} cannot be {quoted(value)}, as it is no number; a {kind.name} says {allowed}: write one"
        )
    if not any(map(compared.has, apart(type, [compared]))):
        raise UseError(f"{name} is never {compared}; a {kind.name} says {type.allowed()}")
    return compared


def apart(type: FactType, ranges: Iterable[Range]) -> tuple[float, ...]:
    """Numbers of a type that tell ranges apart: the limits, and at least one between each two of them.

    The first of a virtual device comes first.
    """
    limits = {limit for each in ranges for limit in (each.lower, each.upper)}
    marks = sorted(each for each in limits | {type.lower, type.upper} if math.isfinite(each))
    near = _whole_numbers_near(marks) if type.type is int else _numbers_near(marks)
    numbers = (each for each in (type.first, *type.words, *near) if isinstance(each, NUMBERS))
    return tuple(dict.fromkeys(filter(type.takes, numbers)))


def _numbers_near(marks: list[float]) -> list[float]:
    if not marks:
        return []
    between = [(one + other) / 2 for one, other in pairwise(marks)]
    return [float(each) for each in sorted([marks[0] - 1, *marks, *between, marks[-1] + 1])]


def _whole_numbers_near(marks: list[float]) -> list[int]:
    near = {math.floor(mark) + step for mark in marks for step in (-1, 0, 1)}
    return sorted(near | {math.ceil(mark) + 1 for mark in marks})
