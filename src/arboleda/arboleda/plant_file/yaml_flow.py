"""Plain values as YAML on one line, such that `yaml_marks` reads the same values again."""

from __future__ import annotations

import json
import math
import re
from typing import Any

from .yaml_marks import scalar

WORD = re.compile(r"[A-Za-z$][A-Za-z0-9_.$/-]*", re.ASCII)
KEY = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", re.ASCII)


def flow(value: Any) -> str:
    """The value as a person writes it within a line: `{deg: [10, -5.5], mm: 0}`."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key_text(key)}: {flow(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow, value)) + "]"
    return _word(value) if isinstance(value, str) else _plain(value)


def key_text(key: str) -> str:
    """A key, in quotes only where it needs them; any word is a key."""
    return (
        key
        if re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", key, re.ASCII)
        else json.dumps(key, ensure_ascii=False)
    )


def _word(text: str) -> str:
    is_plain = WORD.fullmatch(text) and scalar(text) == text
    return text if is_plain else json.dumps(text, ensure_ascii=False)


def _plain(value: bool | int | float | None) -> str:
    if value is None or isinstance(value, bool):
        return "null" if value is None else str(value).lower()
    if isinstance(value, float) and math.isfinite(value):
        return repr(value).removesuffix(".0")
    return str(value)
