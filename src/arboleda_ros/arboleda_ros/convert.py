"""Conversion between the core's values and ROS 2 messages; raises PayloadError for bad ones. SI units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from sensor_msgs.msg import JointState
from std_msgs.msg import Float32MultiArray, MultiArrayDimension, String, UInt8

from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.declared import Device, VerbCall
from arboleda.kinds.joints import Jointed, MoveJoints
from arboleda.kinds.mobile import FollowPath, Mobile
from arboleda.model.by_class import nearest
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.counting import counted
from arboleda.model.errors import PayloadError
from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState, Robot
from arboleda.wire import order
from arboleda.wire.hop import COMMAND, ORDER, PLAIN, kind_of, loses_its_id
from arboleda.wire.joints import joint_names
from arboleda.wire.status import (
    from_heard_labels,
    from_label,
    from_token_labels,
    to_heard_label,
    to_label,
    to_token_label,
)

COPY = "copy"  # the label of what the topic `command` carries, too; there, of what is copied

_AT_NODE = 0.125  # share of the pitch: a mobile farther from every node is between nodes


COMMANDS: dict[type[Robot], tuple[type[Command], ...]] = {
    Device: (VerbCall, Stop),
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
    if kind is VerbCall:
        return String
    return Float32MultiArray if kind in (MoveJoints, FollowPath) else UInt8


def ordered(robot: Robot) -> tuple[type, str]:
    """The type and the topic that carries all commands of a robot with their ids, in one order."""
    if isinstance(robot, Device):
        return String, f"{robot.name}/{ORDER}"
    return Float32MultiArray, f"{robot.name}/{COMMAND}"


def command_message(command: Command, *, copy: bool = False) -> Float32MultiArray | UInt8 | String:
    """A command as its plain topic carries it; arrays are labelled with the id, and as copies."""
    if isinstance(command, VerbCall):
        return String(data=order.write(command))
    if not loses_its_id(command):
        return _labelled(command.id, _values(command), *((COPY,) if copy else ()))
    return UInt8(data=int(_values(command)[0]))


def labelled_message(robot: Robot, command: Command, *, copied: bool) -> Float32MultiArray | String:
    """A command for the robot's topic of all commands.

    It carries the id, the telemetry that the plant had heard of the robot, what its board is to echo, and
    whether its plain topic has a copy.
    """
    if isinstance(robot, Device):
        return String(data=order.write(command, copied=copied))
    heard = () if command.heard is None else (to_heard_label(command.heard),)
    token = () if command.token is None else (to_token_label(command.token),)
    more = (*((COPY,) if copied else ()), *heard, *token)
    return _labelled(command.id, _values(command), PLAIN[kind_of(command)], *more)


def is_copy(message: Float32MultiArray | UInt8) -> bool:
    """True if a message of a plain topic is marked as a copy of one on `command`; UInt8 has no mark."""
    return isinstance(message, Float32MultiArray) and any(dim.label == COPY for dim in message.layout.dim[1:])


def labelled_command(robot: Robot, message: Float32MultiArray | String) -> tuple[Command, bool]:
    """The command in a message of the robot's topic of all commands; True if a UInt8 copy of it comes."""
    if isinstance(robot, Device):
        return order.read(robot, message.data)
    labels = [dim.label for dim in message.layout.dim]
    topics = _topics(robot.__class__)
    if len(labels) < 2 or labels[1] not in topics:
        raise PayloadError(
            f"{robot.name}: the labels are {ascii(labels)[:60]}; id=<command id> and one of "
            f"{', '.join(topics)} are needed"
        )
    kind = topics[labels[1]]
    if message_type(kind) is Float32MultiArray:
        given = command(kind, robot, message)
    else:
        id, values = _unlabelled(message, robot.name)
        if len(values) != 1 or values[0] not in range(256):
            raise PayloadError(f"{robot.name}: {labels[1]} needs one whole number of 0 to 255")
        given = replace(command(kind, robot, UInt8(data=int(values[0]))), id=id)
    if not given.id:
        first = ascii(labels[0])[:40]
        raise PayloadError(f"{robot.name}: the first label is {first}; id=<command id> is needed")
    given = replace(given, heard=from_heard_labels(labels[2:]), token=from_token_labels(labels[2:]))
    return given, COPY in labels[2:] and loses_its_id(given)


def command(kind: type[Command], robot: Robot, message: Float32MultiArray | UInt8) -> Command:
    """The command in a message of `robot`'s plain topic; its id is "" if the message has none."""
    if isinstance(robot, Jointed) and kind is MoveJoints:
        id, values = _unlabelled(message, robot.name)
        return MoveJoints(id=id, robot=robot.name, q=_joints(robot, values))
    if isinstance(robot, Mobile) and kind is FollowPath:
        id, values = _unlabelled(message, robot.name)
        return FollowPath(id=id, robot=robot.name, nodes=_nodes(robot, values))
    if isinstance(robot, Device) and kind is VerbCall:
        return order.read(robot, message.data)[0]
    if kind is SetEffector:
        return SetEffector(id="", robot=robot.name, on=bool(_one_of(message, (0, 1))))
    if kind is Stop:
        return Stop(id="", robot=robot.name, mode=StopMode(_one_of(message, tuple(StopMode))))
    _one_of(message, (1,))
    return Home(id="", robot=robot.name)


def state_report(at: float, robot: Robot, message: UInt8) -> Report:
    """The report that a `motion_state` makes."""
    state = MotionState(_one_of(message, tuple(MotionState)))
    return Report(at=at, robot=robot.name, state=state)


def joints_report(at: float, robot: Robot, message: JointState) -> Report:
    """The report that a `joint_states` makes; a mobile between two nodes reports no node."""
    measured = _positions(joint_names(robot), message)
    if isinstance(robot, Mobile):
        return Report(at=at, robot=robot.name, node=_nearest(robot, *measured))
    return Report(at=at, robot=robot.name, q=measured)


def _values(command: Command) -> Sequence[float]:
    if isinstance(command, MoveJoints):
        return command.q
    if isinstance(command, FollowPath):
        return command.nodes
    if isinstance(command, SetEffector):
        return (int(command.on),)
    return (int(command.mode) if isinstance(command, Stop) else 1,)


def _labelled(id: str, values: Sequence[float], *more: str) -> Float32MultiArray:
    """The values with labels; further labels have size and stride 1, so that the layout stays the same."""
    message = Float32MultiArray(data=[float(value) for value in values])
    size = len(message.data)
    first = MultiArrayDimension(label=to_label(id), size=size, stride=size)
    message.layout.dim = [first, *(MultiArrayDimension(label=label, size=1, stride=1) for label in more)]
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


def _positions(names: tuple[str, ...], message: JointState) -> tuple[float, ...]:
    """The positions of `names`, wherever they stand in the message."""
    if len(message.name) != len(message.position):
        named, positions = (
            counted(len(message.name), "joint name"),
            counted(len(message.position), "position"),
        )
        raise PayloadError(f"{named} but {positions}")
    found = dict(zip(message.name, message.position, strict=True))
    missing = [name for name in names if name not in found]
    if missing:
        raise PayloadError(f"joint {', '.join(missing)} is missing; needed are {', '.join(names)}")
    if not all(math.isfinite(found[name]) for name in names):
        raise PayloadError(f"a position of {', '.join(names)} is not a finite number")
    return tuple(found[name] for name in names)


def _nearest(mobile: Mobile, x: float, y: float) -> int | None:
    grid = mobile.grid
    distances = [math.dist((x, y), grid.position(node)) for node in range(grid.size)]
    node = min(range(grid.size), key=distances.__getitem__)
    return node if distances[node] <= _AT_NODE * grid.pitch else None
