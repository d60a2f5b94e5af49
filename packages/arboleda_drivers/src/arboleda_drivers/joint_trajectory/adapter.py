"""The driver `follow_joint_trajectory`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.drivers import Robot, driver
from arboleda_drivers.joint_trajectory.machine import Trajectory, machine
from arboleda_drivers.joint_trajectory.settings import Settings
from arboleda_drivers.ros_action.action_client import ActionClientDriver
from arboleda_drivers.ros_action.joint_states import listen_to_joints
from arboleda_drivers.ros_action.machine import Machine


@driver("follow_joint_trajectory", settings=Settings)
class FollowJointTrajectory(ActionClientDriver):
    """Driver of one arm behind a joint trajectory controller."""

    package = "control_msgs"
    type_name = "FollowJointTrajectory"

    def mover(self, devices: Sequence[Robot]) -> Machine:
        return machine(devices, self.settings)

    def listen(self, node: Any) -> None:
        listen_to_joints(node, self.settings.joint_states, self.see)

    def goal(self, action: Any, goal: Trajectory) -> Any:
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

        seconds, rest_s = divmod(goal.duration_s, 1)
        still = [0.0] * len(goal.q)
        point = JointTrajectoryPoint(
            positions=list(goal.q),
            velocities=still,
            accelerations=still,
            time_from_start=Duration(sec=int(seconds), nanosec=int(rest_s * 1e9)),
        )
        return action.Goal(trajectory=JointTrajectory(joint_names=list(goal.joints), points=[point]))

    def end(self, result: Any) -> dict[str, Any]:
        return {"error": result.error_code, "text": result.error_string}
