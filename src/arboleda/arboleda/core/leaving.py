"""Which messages of a plant may leave it although they are late, or once it can keep nothing more."""

from __future__ import annotations

from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Heartbeat, Notice
from arboleda.model.sentence import Phrase

from .plant import Plant

SENT_TOO_LATE = Phrase("command.too_late", "the plant was away for {seconds:.1f} s before it could send this")


def ends_motion(message: Command | Notice) -> bool:
    """Whether it is a stop: it is never too late, and needs nothing to be kept."""
    return isinstance(message, Stop) and message.mode is not StopMode.CLEAR


def is_too_late(message: Command | Notice, plant: Plant, now: float) -> bool:
    """Whether the plant was away between its step and now: what was right then is not sent any more."""
    stale = now - plant.now > plant.away_after_s
    return stale and isinstance(message, Command) and not ends_motion(message)


def leaves_unkept(message: Command | Notice) -> bool:
    """Whether it leaves a plant that can keep nothing more: stops do, and the beat with which they count."""
    return isinstance(message, Heartbeat) or ends_motion(message)
