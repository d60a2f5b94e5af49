"""Fields of `joint_states` on ROS 2 for a robot: topic, joint names, and measured values."""

from __future__ import annotations

from arboleda.model.messages import Report
from arboleda.model.plant_model import MotionState, Robot


def measured_joints(robot: Robot, report: Report) -> tuple[float, ...] | None:
    """The joints of a report, x and y of a mobile; None if it has none, or the robot has no link."""
    return None if report.state is MotionState.NO_LINK else robot.measured(report)


def joint_names(robot: Robot) -> tuple[str, ...]:
    """The names of a robot's joints in the twin."""
    return robot.joint_names


def joint_states_topic(robot: Robot) -> str:
    """The topic of a robot's joint states: under the twin's name for an arm, its own for a mobile."""
    return f"{robot.twin_name}/joint_states"
