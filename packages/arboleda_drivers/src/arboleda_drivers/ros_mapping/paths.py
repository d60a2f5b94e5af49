"""Path into a message of ROS 2: names, and numbers of items in lists, `pose.position.x` or `position[0]`."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from arboleda.drivers import DriverError

STEP = re.compile(r"(?:^|\.)([A-Za-z]\w*)|\[(\d+)\]")


@lru_cache(maxsize=1024)
def steps(text: str) -> tuple[str | int, ...]:
    """The steps of a path; raises DriverError for a text that is none."""
    found: list[str | int] = []
    at = 0
    while at < len(text) or not found:
        match = STEP.match(text, at)
        if match is None or text[0] in ".[":
            raise DriverError(f'"{text}" is no field; write it as pose.position.x or position[0]')
        found.append(match[1] if match[2] is None else int(match[2]))
        at = match.end()
    return tuple(found)


def value_at(message: object, path: str) -> object:
    """The value of a field; None where a list on the way has no such item."""
    value: Any = message
    for step in steps(path):
        if isinstance(step, str):
            value = getattr(value, step)
        elif step >= len(value):
            return None
        else:
            value = value[step]
    return value.item() if hasattr(value, "item") else value  # what numpy holds
