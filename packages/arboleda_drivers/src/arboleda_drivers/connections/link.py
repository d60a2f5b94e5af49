"""Events and messages of a machine whose device is at the other end of connections."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.drivers import Command


class LinkBroken(ValueError):
    """Error: what came over the connections, or did not come, makes them useless; the sentence says why."""


@dataclass(frozen=True, kw_only=True)
class Opened:
    """Event: all connections are open."""


@dataclass(frozen=True, kw_only=True)
class Closed:
    """Event: one connection broke, or could not be made; the others have been closed as well."""

    why: str


@dataclass(frozen=True, kw_only=True)
class CommandRequest:
    """Event: the plant commands the device."""

    command: Command


@dataclass(frozen=True, kw_only=True)
class Open:
    """Message: open all connections."""


@dataclass(frozen=True, kw_only=True)
class Close:
    """Message: close all connections."""


@dataclass(frozen=True, kw_only=True)
class CommandNotSent:
    """Message: the command that the plant gave cannot leave."""

    why: str


@dataclass(frozen=True, kw_only=True)
class LogLine:
    """Message: a sentence for the log."""

    text: str
