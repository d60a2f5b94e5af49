"""Text of a record: its times and its sentences as people read them."""

from __future__ import annotations

from contextlib import suppress
from datetime import datetime
from typing import Any

from arboleda.recorder.plain_data import sentence_from


def moment(unix_ns: int, digits: str = "seconds") -> str:
    """A time with its date, in this machine's time zone."""
    with suppress(OverflowError, OSError, ValueError):
        return datetime.fromtimestamp(unix_ns / 1e9).isoformat(" ", digits)
    return "?"


def sentence_of(data: Any) -> str:
    """The sentence in English; "" if there is none, or none that can be read."""
    try:
        return str(sentence_from(data) or "")
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        return ""
