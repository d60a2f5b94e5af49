"""Rows of a launch as plain data, one for each node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Value = str | float | int | bool


@dataclass(frozen=True, kw_only=True)
class Row:
    """One node; where a `required` one ends, the launch ends."""

    package: str
    executable: str
    namespace: str = ""
    parameters: Mapping[str, Value] = field(default_factory=dict)
    arguments: tuple[str, ...] = ()
    required: bool = False


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The nodes, what is added to their environment, and lines for the person at the screen."""

    rows: list[Row]
    environment: Mapping[str, str]
    notes: list[str]
