"""Text of a record: its times and its sentences as people read them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from datetime import datetime
from typing import Any

from arboleda.model.sentence import Sentence
from arboleda.recorder.plain_data import sentence_from


def moment(unix_ns: int, digits: str = "seconds") -> str:
    """A time with its date, in this machine's time zone."""
    with suppress(OverflowError, OSError, ValueError):
        return datetime.fromtimestamp(unix_ns / 1e9).isoformat(" ", digits)
    return "?"


def sentence_of(data: Any, say: Callable[[Sentence | str], str] = str) -> str:
    """The sentence as `say` says it, else in English; "" if there is none, or none that can be read."""
    try:
        return say(sentence_from(data) or "")
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        return ""
