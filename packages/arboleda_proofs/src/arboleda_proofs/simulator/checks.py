"""Checks of a file that tells a run what to do: their sentences name the place in the file that is wrong."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from arboleda.drivers import ArboledaError

NUMBERS = ("at", "seconds", "amount", "seed")  # the fields of a fault that are numbers


class BadFaults(ArboledaError):
    """An impossible entry in a file of faults; `place` are the keys and positions that lead to it."""

    def __init__(self, sentence: str, *place: str | int) -> None:
        super().__init__(sentence)
        self.place = place


@contextmanager
def within(*place: str | int) -> Iterator[None]:
    """Add `place` in front of the place of every BadFaults that is raised inside."""
    try:
        yield
    except BadFaults as bad:
        bad.place = (*place, *bad.place)
        raise


def is_number(value: Any) -> bool:
    """True if `value` is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def only(data: Any, allowed: Sequence[str], where: str) -> dict[str, Any]:
    """`data` as a mapping that has no other keys than the known ones; raises BadFaults otherwise."""
    if not isinstance(data, dict):
        raise BadFaults(f"{where} is not a mapping; its keys are {', '.join(allowed)}")
    for key in data:
        if key not in allowed:
            raise BadFaults(f"{where} has no {key!r}; allowed: {', '.join(allowed)}", key)
    return data


def check_field(name: str, value: Any) -> None:
    """Raises BadFaults for a field of a fault that is of another type than it has to be."""
    if name not in NUMBERS and not isinstance(value, str):
        raise BadFaults(f"{name} of a fault is {value!r}; a text is needed")
    if name in NUMBERS and not is_number(value):
        raise BadFaults(f"{name} of a fault is {value!r}; a number is needed")
