"""Tables by class, in which the row of the nearest base counts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

T = TypeVar("T")


def nearest(rows: Mapping[type[Any], T], kind: type[Any]) -> T | None:
    """The row of a class, or of its nearest base that has one; None where none has."""
    for base in kind.__mro__:  # a loop costs less than a generator, and each command asks five times
        if base in rows:
            return rows[base]
    return None
