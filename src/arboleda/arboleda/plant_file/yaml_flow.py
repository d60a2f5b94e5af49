"""Plain values as YAML, such that `yaml_marks` reads the same values again."""

from __future__ import annotations

import json
import math
import re
from typing import Any

from .yaml_marks import scalar

WORD = re.compile(r"[A-Za-z$][A-Za-z0-9_.$/-]*|[0-9]+(\.[0-9]+){2,3}", re.ASCII)
KEY = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", re.ASCII)
WIDEST = 110  # characters of a line that people read
STEP = "  "


def flow(value: Any) -> str:
    """The value as a person writes it within a line: `{deg: [10, -5.5], mm: 0}`."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key_text(key)}: {flow(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow, value)) + "]"
    return _word(value) if isinstance(value, str) else _plain(value)


def block(head: str, value: Any, indent: str, newline: str) -> str:
    """An entry of a mapping as a person writes it: on one line, or on several where it is too long.

    `head` is its key with the colon, `indent` what stands before it on its line.
    """
    line = f"{head} {flow(value)}"
    if len(indent) + len(line) <= WIDEST or not (value and isinstance(value, dict | list)):
        return line
    inner = indent + STEP
    if isinstance(value, dict):
        rows = [block(f"{key_text(key)}:", each, inner, newline) for key, each in value.items()]
    else:
        rows = [f"- {flow(each)}" for each in value]
    return newline.join([head.rstrip(), *(f"{inner}{row}" for row in rows)])


def key_text(key: str) -> str:
    """A key, in quotes only where it needs them; any word is a key."""
    return key if KEY.fullmatch(key) else json.dumps(key, ensure_ascii=False)


def _word(text: str) -> str:
    is_plain = WORD.fullmatch(text) and scalar(text) == text
    return text if is_plain else json.dumps(text, ensure_ascii=False)


def _plain(value: bool | int | float | None) -> str:
    if value is None or isinstance(value, bool):
        return "null" if value is None else str(value).lower()
    if isinstance(value, float) and math.isfinite(value):
        return repr(value).removesuffix(".0")
    return str(value)
