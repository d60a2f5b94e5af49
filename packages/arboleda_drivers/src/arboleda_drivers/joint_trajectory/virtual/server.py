"""The virtual joint trajectory controller over ROS 2."""

from __future__ import annotations

from typing import Any

from arboleda_drivers.joint_trajectory.virtual.machine import ArmBody, Points
from arboleda_drivers.ros_action.events import GoalResult
from arboleda_drivers.ros_action.virtual.machine import VirtualServer
from arboleda_drivers.ros_action.virtual.server import ActionController, Protocol, joint_sensors
from arboleda_drivers.virtual.faults import Faults


def controller(
    faults: Faults, *, action: str, joint_states: str, joints: tuple[str, ...], rate: float, lan: bool
) -> ActionController:
    protocol = Protocol(
        package="control_msgs",
        type_name="FollowJointTrajectory",
        goal=_goal,
        result=_result,
        sensors=joint_sensors(joint_states),
    )
    machine = VirtualServer(ArmBody(joints, faults), faults, measure_s=1 / rate)
    return ActionController(machine, protocol, action=action, what="the virtual arm", lan=lan)


def _goal(goal: Any) -> Points:
    points = goal.trajectory.points
    times = (each.time_from_start.sec + each.time_from_start.nanosec / 1e9 for each in points)
    rows = zip(times, (tuple(each.positions) for each in points), strict=True)
    return Points(joints=tuple(goal.trajectory.joint_names), points=tuple(rows))


def _result(result: Any, end: GoalResult) -> None:
    result.error_code, result.error_string = end.error, end.text
