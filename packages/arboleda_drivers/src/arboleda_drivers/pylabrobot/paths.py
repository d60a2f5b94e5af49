"""Path to a value of a machine: names, items and calls, `head[0].has_tip` or `get_temperature()`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from arboleda.drivers import DriverError

STEP = re.compile(r"\.?([A-Za-z]\w*)|\[([^\[\]]+)\]|(\(\))")


@dataclass(frozen=True, kw_only=True)
class Step:
    """Step of a path: an attribute by its name, an item by its key, or a call without arguments."""

    kind: Literal["name", "item", "call"]
    key: str = ""


@lru_cache(maxsize=1024)
def steps(text: str) -> tuple[Step, ...]:
    """The steps of a path; raises DriverError for a text that is none."""
    found: list[Step] = []
    at = 0
    while at < len(text):
        match = STEP.match(text, at)
        if match is None or text.startswith("."):
            raise DriverError(f"{text} is no path; write it as head[0].has_tip or get_temperature()")
        name, item, _ = match.groups()
        kind: Literal["name", "item", "call"] = "name" if name else "item" if item else "call"
        found.append(Step(kind=kind, key=name or item or ""))
        at = match.end()
    return tuple(found)
