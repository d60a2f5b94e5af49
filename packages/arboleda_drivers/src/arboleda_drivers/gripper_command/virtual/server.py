"""The virtual gripper over ROS 2, by either of the two actions that grippers have."""

from __future__ import annotations

from typing import Any

from arboleda_drivers.gripper_command.virtual.machine import Grip, GripperBody
from arboleda_drivers.ros_action.events import GoalResult
from arboleda_drivers.ros_action.virtual.machine import VirtualServer
from arboleda_drivers.ros_action.virtual.server import ActionController, Protocol, joint_sensors
from arboleda_drivers.virtual.faults import Faults


def controller(
    faults: Faults,
    *,
    action: str,
    parallel: bool,
    joint_states: str,
    joint: str,
    opened: float,
    part: float,
    speed: float,
    rate: float,
    lan: bool,
) -> ActionController:
    body = GripperBody(joint, faults, opened=opened, part=part, speed=speed)
    protocol = Protocol(
        package="control_msgs",
        type_name="ParallelGripperCommand" if parallel else "GripperCommand",
        goal=_parallel_goal if parallel else _goal,
        result=_result,
        sensors=joint_sensors(joint_states),
    )
    machine = VirtualServer(body, faults, measure_s=1 / rate)
    return ActionController(machine, protocol, action=action, what="the virtual gripper", lan=lan)


def _goal(goal: Any) -> Grip:
    return Grip(position=goal.command.position, effort=goal.command.max_effort)


def _parallel_goal(goal: Any) -> Grip:
    """The goal in a message; one without a position becomes NaN, which is refused."""
    positions, efforts = goal.command.position, goal.command.effort
    return Grip(position=positions[0] if positions else float("nan"), effort=efforts[0] if efforts else 0.0)


def _result(result: Any, end: GoalResult) -> None:
    result.stalled, result.reached_goal = end.stalled, not end.stalled
