"""What `joint_states` on ROS 2 say of a robot: on which topic, under which names, and what was measured."""

from __future__ import annotations

from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState, Robot


def measured_joints(robot: Robot, report: Report) -> tuple[float, ...] | None:
    """The joints of a report, x and y of a mobile; None where it holds none, or nobody hears the robot."""
    return None if report.state is MotionState.NO_LINK else robot.measured(report)


def joint_names(robot: Robot) -> tuple[str, ...]:
    """The names a robot's joints have in the twin."""
    return robot.joint_names


def joint_states_topic(robot: Robot) -> str:
    """Arms publish their joints under the name of their twin, mobiles under their own."""
    return f"{robot.twin_name}/joint_states"
