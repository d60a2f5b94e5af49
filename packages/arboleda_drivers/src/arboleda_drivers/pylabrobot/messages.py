"""Events and messages between the state machine of the driver and its machine's event loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.drivers import Report
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened

from .settings import Call


@dataclass(frozen=True, kw_only=True)
class Begun:
    """Event: the calls of this number wait for something, so PyLabRobot has taken the first."""

    number: int


@dataclass(frozen=True, kw_only=True)
class Returned:
    """Event: the last call of this number has returned."""

    number: int
    result: object = None


@dataclass(frozen=True, kw_only=True)
class Raised:
    """Event: a call of this number raised an exception; `first`: none came before that."""

    number: int
    name: str
    text: str
    first: bool = False


@dataclass(frozen=True, kw_only=True)
class Looked:
    """Event: the values at the paths of a look."""

    number: int
    values: Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class LookFailed:
    """Event: a look raised an exception."""

    number: int
    why: str


@dataclass(frozen=True, kw_only=True)
class BeginCalls:
    """Message: begin these calls, one after the other; `result` is the path into what the last returns.

    `beside`: they wait for nothing that is under way.
    """

    number: int
    calls: Sequence[Call]
    result: str = ""
    beside: bool = False


@dataclass(frozen=True, kw_only=True)
class CancelCalls:
    """Message: end the coroutine of this number at the place where it waits."""

    number: int


@dataclass(frozen=True, kw_only=True)
class Look:
    """Message: read the values at these paths; at none it proves that the event loop runs."""

    number: int
    paths: Sequence[str]


Event = Opened | Closed | CommandRequest | Begun | Returned | Raised | Looked | LookFailed
Message = Open | Close | CommandNotSent | Report | BeginCalls | CancelCalls | Look
