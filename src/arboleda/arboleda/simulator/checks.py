"""What a file tells a run is checked with: sentences that know their place in the file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from arboleda.model.errors import ArboledaError


class BadFaults(ArboledaError):
    """Something in a file of faults that cannot be: the sentence says what is allowed, `place` is the way of
    keys and positions to it."""

    def __init__(self, sentence: str, *place: str | int) -> None:
        super().__init__(sentence)
        self.place = place


@contextmanager
def within(*place: str | int) -> Iterator[None]:
    """What is found to be bad inside is so at this place."""
    try:
        yield
    except BadFaults as bad:
        bad.place = (*place, *bad.place)
        raise


def is_number(value: Any) -> bool:
    """Whether it is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def only(data: Any, allowed: Sequence[str], where: str) -> dict[str, Any]:
    """`data` as a mapping with no other keys; BadFaults."""
    if not isinstance(data, dict):
        raise BadFaults(f"{where} is not a mapping; its keys are {', '.join(allowed)}")
    for key in data:
        if key not in allowed:
            raise BadFaults(f"{where} has no {key!r}; allowed: {', '.join(allowed)}", key)
    return data
