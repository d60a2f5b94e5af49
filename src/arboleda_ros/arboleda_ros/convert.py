"""Between the core's values and ROS 2 messages, both ways; bad messages raise PayloadError. SI units."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sensor_msgs.msg import JointState
from std_msgs.msg import Float32MultiArray, MultiArrayDimension, UInt8

from arboleda.core.errors import PayloadError
from arboleda.core.messages import Command, FollowPath, Home, MoveJoints, Report, SetEffector, Stop, StopMode
from arboleda.core.model import Arm, Mobile, MotionState, Robot
from arboleda.wire.status import from_label, to_label

COMMAND_TOPICS: dict[type[Command], str] = {
    MoveJoints: "joint_goals_q",
    FollowPath: "path_cmd",
    SetEffector: "effector_cmd",
    Stop: "stop_cmd",
    Home: "home_cmd",
}

_AT_NODE = 0.125  # of the pitch: a mobile farther than this from every node is between nodes


def commands_of(robot: Robot) -> tuple[type[Command], ...]:
    """The kinds of command a robot takes."""
    return (MoveJoints, SetEffector, Stop, Home) if isinstance(robot, Arm) else (FollowPath, Stop, Home)


def message_type(kind: type[Command]) -> type:
    """The ROS 2 type of a command topic."""
    return Float32MultiArray if kind in (MoveJoints, FollowPath) else UInt8


def command_message(command: Command) -> Float32MultiArray | UInt8:
    """A command as its topic carries it; arrays are labelled with the command id."""
    if isinstance(command, MoveJoints):
        return _labelled(command.id, command.q)
    if isinstance(command, FollowPath):
        return _labelled(command.id, command.nodes)
    if isinstance(command, SetEffector):
        return UInt8(data=int(command.on))
    return UInt8(data=int(command.mode) if isinstance(command, Stop) else 1)


def command(kind: type[Command], robot: Robot, message: Float32MultiArray | UInt8) -> Command:
    """The command in a message of `robot`'s topic; the id is "" where the message carries none."""
    if isinstance(robot, Arm) and kind is MoveJoints:
        id, values = _unlabelled(message, robot.name)
        return MoveJoints(id=id, robot=robot.name, q=_joints(robot, values))
    if isinstance(robot, Mobile) and kind is FollowPath:
        id, values = _unlabelled(message, robot.name)
        return FollowPath(id=id, robot=robot.name, nodes=_nodes(robot, values))
    if kind is SetEffector:
        return SetEffector(id="", robot=robot.name, on=bool(_one_of(message, (0, 1))))
    if kind is Stop:
        return Stop(id="", robot=robot.name, mode=StopMode(_one_of(message, tuple(StopMode))))
    _one_of(message, (1,))
    return Home(id="", robot=robot.name)


def state_report(at: float, robot: Robot, message: UInt8) -> Report:
    """What a `motion_state` says."""
    state = MotionState(_one_of(message, tuple(MotionState)))
    return Report(at=at, robot=robot.name, state=state)


def joints_report(at: float, robot: Robot, message: JointState) -> Report:
    """What a `joint_states` says; a mobile between two nodes reports no node."""
    measured = _positions(joint_names(robot), message)
    if isinstance(robot, Mobile):
        return Report(at=at, robot=robot.name, node=_nearest(robot, *measured))
    return Report(at=at, robot=robot.name, q=measured)


def measured_joints(robot: Robot, report: Report) -> tuple[float, ...] | None:
    """The joints of a report, x and y of a mobile; None where it holds none, or nobody hears the robot."""
    if report.state is MotionState.NO_LINK:
        return None
    if isinstance(robot, Mobile):
        return None if report.node is None else robot.grid.position(report.node)
    return report.q


def joint_names(robot: Robot) -> tuple[str, ...]:
    """The names a robot's joints have in the twin."""
    if isinstance(robot, Arm):
        return tuple(f"{robot.twin}_{joint.name}" for joint in robot.joints)
    return (f"{robot.name}_x_joint", f"{robot.name}_y_joint")


def joint_states_topic(robot: Robot) -> str:
    """Arms publish their joints under the name of their twin, mobiles under their own."""
    return f"{robot.twin if isinstance(robot, Arm) else robot.name}/joint_states"


def _labelled(id: str, values: Sequence[float]) -> Float32MultiArray:
    message = Float32MultiArray(data=[float(value) for value in values])
    size = len(message.data)
    message.layout.dim = [MultiArrayDimension(label=to_label(id), size=size, stride=size)]
    return message


def _unlabelled(message: Float32MultiArray, robot: str) -> tuple[str, tuple[float, ...]]:
    """The command id and the numbers; a label of somebody else's making counts as none."""
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


def _joints(arm: Arm, values: tuple[float, ...]) -> tuple[float, ...]:
    if len(values) != len(arm.joints):
        raise PayloadError(f"{arm.name} has {len(arm.joints)} joints, but the goal has {len(values)} numbers")
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
        raise PayloadError(f"{len(message.name)} joint names but {len(message.position)} positions")
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
