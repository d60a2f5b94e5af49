"""Path to a value within others: names, and numbers of items in lists, `motor.angle` or `axes[0].mm`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from arboleda.drivers import DriverError

KEY = re.compile(r"(?:^|\.)([^.\[\]]+)|\[(\d+)\]")  # in JSON
FIELD = re.compile(r"(?:^|(?<!^)\.)([A-Za-z]\w*)|(?<!^)\[(\d+)\]")  # in messages of ROS 2
NOTHING = object()
"""In place of a value that is not there."""


@lru_cache(maxsize=1024)
def steps(path: str, form: re.Pattern[str] = KEY) -> tuple[str | int, ...]:
    """The steps of a path, which are of that form; raises DriverError for a text that is none."""
    found: list[str | int] = []
    end = 0
    while end < len(path) or not found:
        match = form.match(path, end)
        if match is None:
            raise DriverError(f'"{path}" is no path; write it as motor.angle or axes[0].mm')
        found.append(match[1] if match[2] is None else int(match[2]))
        end = match.end()
    return tuple(found)


def json_at(path: str, body: Any) -> Any:
    """The value at a path in JSON; NOTHING where there is none."""
    for step in steps(path):
        known = range(len(body)) if isinstance(body, list) else body if isinstance(body, Mapping) else ()
        if step not in known:
            return NOTHING
        body = body[step]
    return body


def field_at(path: str, message: Any) -> Any:
    """The value of a field of a message of ROS 2; None where a list on the way has no such item."""
    for step in steps(path, FIELD):
        if isinstance(step, str):
            message = getattr(message, step)
        elif step >= len(message):
            return None
        else:
            message = message[step]
    return message.item() if hasattr(message, "item") else message  # what numpy holds
