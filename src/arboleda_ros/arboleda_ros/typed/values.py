"""Conversion between the plant's plain data and the messages of arboleda_interfaces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda_interfaces.msg import Task

from .fields import compose

_TASK = ("id", "text", "cell", "state", "reason", "sentence")
_FIELDS = ("text", "cell", "recipe", "path", "station", "id")


def task_message(plain: Mapping[str, Any]) -> Task:
    """The message of a task as the view has it, or of a change; unknown fields are empty."""
    return Task(**{key: str(plain[key] or "") for key in _TASK})


def text_of(request: Any) -> str:
    """The task text in a goal or a request."""
    return compose(**{key: getattr(request, key) for key in _FIELDS})
