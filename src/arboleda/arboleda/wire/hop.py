"""Hop between plant and bridge: the topics of commands, and the data of a command that they carry.

A robot's topic `command` carries all its commands, each with its id, so that none overtakes another. Beside
it there is a plain topic for each kind of command, for nodes that know no ids: UInt8 has no place for an id.
A device of a declared kind has `order` in place of `command`, with verbs and values, for all nodes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.declared import VerbCall
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.facts import shown as shown_value
from arboleda.model.messages import Heartbeat

COMMAND = "command"
ORDER = "order"
HEARTBEAT = "plant/heartbeat"
PLAIN: dict[type[Command], str] = {
    MoveJoints: "joint_goals_q",
    FollowPath: "path_cmd",
    SetEffector: "effector_cmd",
    Stop: "stop_cmd",
    Home: "home_cmd",
    VerbCall: ORDER,
}
"""The plain topic of each kind of command, below the robot's name."""


@dataclass(frozen=True, kw_only=True)
class FromPlant:
    """Message that reaches the bridge over the hop; a command without an id is foreign, or a copy.

    `copied`: the command also comes on its plain topic, without its id. `sender` names the nodes that may
    have published the message, "" where that is unknown. `unix_s` is the time of this machine's clock, None
    for a message that only our own plant can have sent.
    """

    at: float
    message: Command | Heartbeat
    copied: bool = False
    sender: str = ""
    unix_s: int | None = None


def command_topic(command: Command) -> str:
    """The topic of a command with its id."""
    return f"{command.robot}/{COMMAND}"


def plain_topic(command: Command) -> str:
    """The topic of a command for nodes that know no ids."""
    return f"{command.robot}/{PLAIN[kind_of(command)]}"


def kind_of(command: Command) -> type[Command]:
    """The class that has a plain topic: the command's own, or its nearest base."""
    kind = type(command)
    return kind if kind in PLAIN else next(base for base in kind.__mro__ if base in PLAIN)


def is_stop(command: Command | Heartbeat) -> bool:
    """True if a command ends a motion; such a command is obeyed whoever gives it."""
    return isinstance(command, Stop) and command.mode is not StopMode.CLEAR


def loses_its_id(command: Command) -> bool:
    """True if the plain topic of the command has no place for an id."""
    return isinstance(command, SetEffector | Stop | Home)


def without_id(command: Command) -> Command:
    """The command without the data that a plain topic of UInt8 cannot carry."""
    return replace(command, id="", heard=None, token=None)


def shown(command: Command) -> str:
    """The command as people would publish it: `stop_cmd 2`, `joint_goals_q`, `order run program=1001`."""
    if isinstance(command, VerbCall):
        values = (f"{name}={shown_value(value)}" for name, value in command.values)
        return " ".join((ORDER, command.verb, *values))
    name = PLAIN[kind_of(command)]
    if isinstance(command, Stop):
        return f"{name} {int(command.mode)}"
    return f"{name} {int(command.on)}" if isinstance(command, SetEffector) else name
