"""What happens at an action of ROS 2, and what its client is to do."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from arboleda.model.commands import Command
from arboleda.model.messages import Report


class Status(Enum):
    """How a goal ended."""

    SUCCEEDED = auto()
    ABORTED = auto()
    CANCELED = auto()
    UNKNOWN = auto()  # the server does not know the goal


@dataclass(frozen=True, kw_only=True)
class ServersFound:
    """The servers of the action now, each by a number of its own; it changes where one was started anew."""

    servers: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """Something was measured; `stamp` is when the robot says that it was, in whatever clock."""

    stamp: tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class GoalAnswer:
    """The server has accepted a goal, or refused it."""

    id: str
    accepted: bool


@dataclass(frozen=True, kw_only=True)
class GoalResult:
    """The result of a goal has come; `stalled` and `missed` are what some actions say besides."""

    id: str
    status: Status
    error: int = 0
    text: str = ""
    stalled: bool = False
    missed: tuple[int, ...] = ()


@dataclass(frozen=True, kw_only=True)
class CancelAnswer:
    """The server has answered that all of its goals be cancelled."""

    refused: bool


@dataclass(frozen=True, kw_only=True)
class CommandRequest:
    """The plant commands the device."""

    command: Command


@dataclass(frozen=True, kw_only=True)
class SendGoal:
    """Send the server a goal; `goal` is of the action's own kind."""

    id: str
    goal: Any


@dataclass(frozen=True, kw_only=True)
class CancelAll:
    """Have the server cancel all of its goals, whoever sent them."""


@dataclass(frozen=True, kw_only=True)
class CommandNotSent:
    """The command that was asked for cannot leave."""

    why: str


@dataclass(frozen=True, kw_only=True)
class UnusableMessage:
    """The server or the device has said what the machine broke on, in a sentence."""

    why: str


Event = ServersFound | Measurement | GoalAnswer | GoalResult | CancelAnswer | CommandRequest | UnusableMessage
Message = SendGoal | CancelAll | CommandNotSent | Report
