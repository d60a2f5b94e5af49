"""Decoding of messages to a board into the commands that they carry."""

from __future__ import annotations

from functools import lru_cache

from arboleda.drivers import PayloadError
from arboleda.wire.payloads import Goal, decode
from arboleda.wire.topics import parse

RECENT = 64  # each message is read by all who follow its board


@lru_cache(maxsize=RECENT)
def goal(topic: str, payload: bytes, axes: int | None) -> Goal | None:
    """The command in a message to a board; None for a beat and for what nobody can read."""
    try:
        message = decode(parse(topic)[1], payload, axes=axes)
    except PayloadError:
        return None
    return message if isinstance(message, Goal) else None
