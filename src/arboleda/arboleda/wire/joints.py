"""What `joint_states` on ROS 2 say of a robot: on which topic, under which names, and what was measured."""

from __future__ import annotations

from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState, Robot


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
