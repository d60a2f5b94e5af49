"""Events of a ROS 2 action, and the messages to its client."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from arboleda.drivers import Report
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest

from .health import Call, CallAnswer, HealthReading


class Status(Enum):
    """End of a goal, as the action server gives it."""

    SUCCEEDED = auto()
    ABORTED = auto()
    CANCELED = auto()
    UNKNOWN = auto()  # the server does not know the goal


@dataclass(frozen=True, kw_only=True)
class ServersFound:
    """Event: the present servers of the action, each by a number that is new after a restart."""

    servers: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """Event: a measurement; `stamp` is its time by the robot's own clock."""

    stamp: tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class GoalAnswer:
    """Event: the server has accepted or refused a goal."""

    id: str
    accepted: bool


@dataclass(frozen=True, kw_only=True)
class GoalResult:
    """Event: the result of a goal; `stalled` and `missed` are fields of some actions only, `message` is the
    whole result where a mapping names its fields.
    """

    id: str
    status: Status
    error: int = 0
    text: str = ""
    stalled: bool = False
    missed: tuple[int, ...] = ()
    message: Any = None


@dataclass(frozen=True, kw_only=True)
class ListedGoal:
    """Goal in a server's list: its id, 16 bytes, the time of its acceptance, (s, ns), and its end or None."""

    uuid: bytes
    stamp: tuple[int, int]
    status: Status | None


@dataclass(frozen=True, kw_only=True)
class GoalList:
    """Event: the goals that the server still knows, whoever sent them."""

    goals: tuple[ListedGoal, ...]


@dataclass(frozen=True, kw_only=True)
class CancelAnswer:
    """Event: the server has answered the request to cancel all of its goals."""

    refused: bool


@dataclass(frozen=True, kw_only=True)
class SendGoal:
    """Message: send the server a goal by the id `uuid`, of 16 bytes; `goal` is of the action's own kind."""

    id: str
    uuid: bytes
    goal: Any


@dataclass(frozen=True, kw_only=True)
class CancelAll:
    """Message: cancel all goals of the server, whoever sent them."""


@dataclass(frozen=True, kw_only=True)
class MakeCall:
    """Message: make a call that leads the device out of a stop."""

    call: Call


@dataclass(frozen=True, kw_only=True)
class UnusableMessage:
    """Event: a message of the server or device caused an error, which the sentence describes."""

    why: str


Said = GoalAnswer | GoalResult | GoalList | CancelAnswer
"""What the server of an action says."""
Event = ServersFound | Measurement | Said | CommandRequest | HealthReading | CallAnswer | UnusableMessage
Message = SendGoal | CancelAll | MakeCall | CommandNotSent | Report
