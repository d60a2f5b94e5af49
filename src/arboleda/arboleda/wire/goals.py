"""A core command as a board understands it: checked against the robot, quantised, in wire units."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from arboleda.core.commands import Command, Home, Motion, Stop, StopMode
from arboleda.core.model import Robot
from arboleda.kinds.arm import Arm, MoveJoints, SetEffector
from arboleda.kinds.mobile import FollowPath, Mobile

from .payloads import EffectorGoal, Goal, HomeGoal, JointsGoal, PathGoal, StopGoal
from .topics import Channel
from .units import to_wire

FLOAT32_SLACK = 1e-6  # a goal at its limit comes back from a Float32MultiArray this far beyond it (rad, m)


def refusal(robot: Robot, command: Command) -> str | None:
    """The word that refuses a command the robot can never carry out; None where it can."""
    return _CHECKS[type(command)](robot, command)


def goal(robot: Robot, command: Command, *, seq: int | None, epoch: int | None) -> tuple[Channel, Goal]:
    """The channel and the payload of a command that `refusal` let through."""
    channel, payload, body = _GOALS[type(command)]
    return channel, payload(**body(robot, command), seq=seq, epoch=epoch)


def needs_clear(command: Command) -> bool:
    """Whether a stop latch forbids the command: whatever moves, and effector on."""
    return isinstance(command, Motion) or (isinstance(command, SetEffector) and command.on)


def _check_joints(robot: Robot, command: MoveJoints) -> str | None:
    if not isinstance(robot, Arm) or len(command.q) != len(robot.joints):
        return "formato"
    if not all(math.isfinite(value) for value in command.q):
        return "formato"
    rows = zip(robot.joints, command.q, strict=True)
    inside = (joint.lower - FLOAT32_SLACK <= value <= joint.upper + FLOAT32_SLACK for joint, value in rows)
    return None if all(inside) else "limite"


def _check_path(robot: Robot, command: FollowPath) -> str | None:
    if not isinstance(robot, Mobile) or not command.nodes:
        return "formato"
    inside = all(0 <= node < robot.grid.size for node in command.nodes)
    return None if inside else "limite"


def _check_effector(robot: Robot, command: SetEffector) -> str | None:
    return None if isinstance(robot, Arm) else "formato"


def _check_stop(robot: Robot, command: Stop) -> str | None:
    return None if robot.has_stop else "no_stop"


def _check_home(robot: Robot, command: Home) -> str | None:
    return None


def _wire_joints(robot: Arm, command: MoveJoints) -> dict[str, object]:
    rows = zip(robot.joints, robot.quantised(command.q), strict=True)
    return {"q": tuple(to_wire(joint, value) for joint, value in rows)}


_CHECKS: dict[type, Callable[[Robot, Any], str | None]] = {
    MoveJoints: _check_joints,
    FollowPath: _check_path,
    SetEffector: _check_effector,
    Stop: _check_stop,
    Home: _check_home,
}

_GOALS: dict[type, tuple[Channel, Callable[..., Goal], Callable[[Any, Any], dict[str, object]]]] = {
    MoveJoints: (Channel.JOINTS, JointsGoal, _wire_joints),
    FollowPath: (Channel.PATH, PathGoal, lambda robot, command: {"nodes": command.nodes}),
    SetEffector: (Channel.EFFECTOR, EffectorGoal, lambda robot, command: {"on": command.on}),
    Stop: (Channel.STOP, StopGoal, lambda robot, command: {"mode": StopMode(command.mode)}),
    Home: (Channel.HOME, HomeGoal, lambda robot, command: {}),
}
