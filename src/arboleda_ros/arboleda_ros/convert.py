"""Conversion between the core's values and ROS 2 messages; raises PayloadError for bad ones. SI units."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import cast

from std_msgs.msg import Float32MultiArray, MultiArrayDimension, String, UInt8

from arboleda.drivers import (
    Arm,
    Command,
    Device,
    FollowPath,
    Home,
    Jointed,
    Mobile,
    MoveJoints,
    Robot,
    SetEffector,
    Stop,
    StopMode,
    VerbCommand,
)
from arboleda.extension import PayloadError
from arboleda.model.by_class import nearest
from arboleda.model.counting import counted
from arboleda.wire.hop import COMMAND, ORDER, PLAIN, kind_of, loses_its_id
from arboleda_ros import order
from arboleda_ros.labels import (
    from_heard_labels,
    from_label,
    from_token_labels,
    to_heard_label,
    to_label,
    to_token_label,
)

COPY = "copy"  # the label of what the topic `command` carries, too; there, of what is copied


COMMANDS: dict[type[Robot], tuple[type[Command], ...]] = {
    Device: (VerbCommand, Stop),
    Jointed: (MoveJoints, Stop, Home),
    Arm: (MoveJoints, SetEffector, Stop, Home),
    Mobile: (FollowPath, Stop, Home),
}


def commands_of(robot: Robot) -> tuple[type[Command], ...]:
    """The kinds of command a robot takes."""
    return _taken_by(type(robot))


def _taken_by(kind: type[Robot]) -> tuple[type[Command], ...]:
    return nearest(COMMANDS, kind) or (Stop,)


@cache
def _topics(kind: type[Robot]) -> dict[str, type[Command]]:
    """The commands that robots of a class take, by the last word of their plain topics."""
    return {PLAIN[each]: each for each in _taken_by(kind)}


def message_type(kind: type[Command]) -> type:
    """The ROS 2 type of a plain command topic."""
    if kind is VerbCommand:
        return cast(type, String)
    return cast(type, Float32MultiArray if kind in (MoveJoints, FollowPath) else UInt8)


def ordered(robot: Robot) -> tuple[type, str]:
    """The type and the topic that carries all commands of a robot with their ids, in one order."""
    if isinstance(robot, Device):
        return String, f"{robot.name}/{ORDER}"
    return Float32MultiArray, f"{robot.name}/{COMMAND}"


def command_message(
    command: Command, *, copy: bool = False, into: Float32MultiArray | None = None
) -> Float32MultiArray | UInt8 | String:
    """A command as its plain topic carries it; arrays are labelled with the id, and as copies.

    `into`: an array of before that has been published, which is filled anew instead of making another.
    """
    if isinstance(command, VerbCommand):
        return String(data=order.write(command))
    if not loses_its_id(command):
        return _labelled(command.id, _values(command), *((COPY,) if copy else ()), into=into)
    return UInt8(data=int(_values(command)[0]))


def labelled_message(
    robot: Robot, command: Command, *, copied: bool, into: Float32MultiArray | None = None
) -> Float32MultiArray | String:
    """A command for the robot's topic of all commands, in `into` as `command_message` has it.

    It carries the id, the telemetry that the plant had heard of the robot, what its board is to echo, and
    whether its plain topic has a copy.
    """
    if isinstance(robot, Device):
        return String(data=order.write(command, copied=copied))
    heard = () if command.heard is None else (to_heard_label(command.heard),)
    token = () if command.token is None else (to_token_label(command.token),)
    more = (*((COPY,) if copied else ()), *heard, *token)
    return _labelled(command.id, _values(command), PLAIN[kind_of(command)], *more, into=into)


def is_copy(message: Float32MultiArray | UInt8) -> bool:
    """True if a message of a plain topic is marked as a copy of one on `command`; UInt8 has no mark."""
    return isinstance(message, Float32MultiArray) and any(dim.label == COPY for dim in message.layout.dim[1:])


def labelled_command(robot: Robot, message: Float32MultiArray | String) -> tuple[Command, bool]:
    """The command in a message of the robot's topic of all commands; True if a UInt8 copy of it comes."""
    if isinstance(robot, Device):
        return order.read(robot, message.data)
    labels = [dim.label for dim in message.layout.dim]
    kind: type = type(robot)
    topics = _topics(kind)
    if len(labels) < 2 or labels[1] not in topics:
        raise PayloadError(
            f"{robot.name}: the labels are {ascii(labels)[:60]}; id=<command id> and one of "
            f"{', '.join(topics)} are needed"
        )
    kind = topics[labels[1]]
    if message_type(kind) is Float32MultiArray:
        received = command(kind, robot, message)
    else:
        id, values = _unlabelled(message, robot.name)
        if len(values) != 1 or values[0] not in range(256):
            raise PayloadError(f"{robot.name}: {labels[1]} needs one whole number of 0 to 255")
        received = replace(command(kind, robot, UInt8(data=int(values[0]))), id=id)
    if not received.id:
        first = ascii(labels[0])[:40]
        raise PayloadError(f"{robot.name}: the first label is {first}; id=<command id> is needed")
    received = replace(received, heard=from_heard_labels(labels[2:]), token=from_token_labels(labels[2:]))
    return received, COPY in labels[2:] and loses_its_id(received)


def command(kind: type[Command], robot: Robot, message: Float32MultiArray | UInt8) -> Command:
    """The command in a message of `robot`'s plain topic; its id is "" if the message has none."""
    if isinstance(robot, Jointed) and kind is MoveJoints:
        id, values = _unlabelled(message, robot.name)
        return MoveJoints(id=id, robot=robot.name, q=_joints(robot, values))
    if isinstance(robot, Mobile) and kind is FollowPath:
        id, values = _unlabelled(message, robot.name)
        return FollowPath(id=id, robot=robot.name, nodes=_nodes(robot, values))
    if isinstance(robot, Device) and kind is VerbCommand:
        return order.read(robot, message.data)[0]
    if kind is SetEffector:
        return SetEffector(id="", robot=robot.name, on=bool(_one_of(message, (0, 1))))
    if kind is Stop:
        return Stop(id="", robot=robot.name, mode=StopMode(_one_of(message, tuple(StopMode))))
    _one_of(message, (1,))
    return Home(id="", robot=robot.name)


def _values(command: Command) -> Sequence[float]:
    if isinstance(command, MoveJoints):
        return command.q
    if isinstance(command, FollowPath):
        return command.nodes
    if isinstance(command, SetEffector):
        return (int(command.on),)
    return (int(command.mode) if isinstance(command, Stop) else 1,)


def _labelled(
    id: str, values: Sequence[float], *more: str, into: Float32MultiArray | None = None
) -> Float32MultiArray:
    """The values with labels; further labels have size and stride 1, so that the layout stays the same."""
    message = Float32MultiArray() if into is None else into
    message.data = array("f", values)
    labels = message.layout.dim
    if len(labels) != 1 + len(more):
        labels = message.layout.dim = [MultiArrayDimension(size=1, stride=1) for _ in (id, *more)]
    for dimension, label in zip(labels, (to_label(id), *more), strict=True):
        dimension.label = label
    labels[0].size = labels[0].stride = len(values)
    return message


def _unlabelled(message: Float32MultiArray, robot: str) -> tuple[str, tuple[float, ...]]:
    """The command id and the numbers; a label of any other form counts as none."""
    values = tuple(message.data)
    for place, value in enumerate(values, start=1):
        if not math.isfinite(value):
            raise PayloadError(f"{robot}: number {place} is {value}; only finite numbers are allowed")
    if not message.layout.dim:
        return "", values
    first = message.layout.dim[0]
    id = from_label(first.label)
    if id and first.size != len(values):
        raise PayloadError(f"{robot}: {first.label} announces {first.size} numbers, but {len(values)} came")
    return id, values


def _joints(arm: Jointed, values: tuple[float, ...]) -> tuple[float, ...]:
    if len(values) != len(arm.joints):
        joints, numbers = counted(len(arm.joints), "joint"), counted(len(values), "number")
        raise PayloadError(f"{arm.name} has {joints}, but the goal has {numbers}")
    return values


def _nodes(mobile: Mobile, values: tuple[float, ...]) -> tuple[int, ...]:
    if not values:
        raise PayloadError(f"{mobile.name}: the path is empty; it needs at least one grid node")
    for value in values:
        if not value.is_integer() or not 0 <= value < mobile.grid.size:
            last = mobile.grid.size - 1
            raise PayloadError(f"{mobile.name}: {value:g} is no grid node; allowed are 0 to {last}")
    return tuple(int(value) for value in values)


def _one_of(message: UInt8, allowed: Sequence[int]) -> int:
    if message.data not in allowed:
        words = ", ".join(str(int(value)) for value in allowed)
        raise PayloadError(f"the value {message.data} means nothing; allowed: {words}")
    return int(message.data)
