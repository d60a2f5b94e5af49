"""Tables by class, in which the row of the nearest base counts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

Row = TypeVar("Row")


def nearest(rows: Mapping[type[Any], Row], kind: type[Any]) -> Row | None:
    """The row of a class, or of its nearest base that has one; None where none has."""
    for base in kind.__mro__:  # no generator: most have a row of their own, and commands ask this five times
        if base in rows:
            return rows[base]
    return None
