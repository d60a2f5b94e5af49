"""Events of a mapped device, and the messages to its adapter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Report
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest
from arboleda_drivers.ros_action.events import Said, UnusableMessage
from arboleda_drivers.ros_action.presence import End, Found

from .heard_facts import Told
from .keys import Call


@dataclass(frozen=True, kw_only=True)
class EndsFound:
    """Event: who is at the other ends, each by a number; see `Presence`."""

    found: Found


@dataclass(frozen=True, kw_only=True)
class GoalRequest(CommandRequest):
    """Event: the plant commands the device; `payload` is the message for a verb, made already."""

    payload: Any = None


@dataclass(frozen=True, kw_only=True)
class ActionSaid:
    """Event: what the server of an action has said."""

    end: End
    said: Said


@dataclass(frozen=True, kw_only=True)
class Response:
    """Event: the response to a request; None where there will be none."""

    id: str
    message: Any


@dataclass(frozen=True, kw_only=True)
class MessageHeard:
    """Event: a message of a topic, or the feedback of a goal."""

    told: Told
    message: Any


@dataclass(frozen=True, kw_only=True)
class Send:
    """Message: send a goal, with its id of 16 bytes, a request or a message; `payload` None: of the call
    without parameters."""

    call: Call
    id: str
    payload: Any = None
    uuid: bytes = b""


@dataclass(frozen=True, kw_only=True)
class CancelGoals:
    """Message: cancel all goals of the server of an action, whoever sent them."""

    end: End


Event = EndsFound | GoalRequest | ActionSaid | Response | MessageHeard | UnusableMessage
Message = Send | CancelGoals | CommandNotSent | Report
