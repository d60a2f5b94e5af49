"""The driver `gripper_command`, for both actions that grippers of ros2_control have."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.drivers import Robot, driver
from arboleda_drivers.gripper_command.machine import Width, machine
from arboleda_drivers.gripper_command.settings import Settings
from arboleda_drivers.ros_action.action_client import ActionClientDriver
from arboleda_drivers.ros_action.joint_states import listen_to_joints
from arboleda_drivers.ros_action.machine import Machine

TYPES = {"single": "GripperCommand", "parallel": "ParallelGripperCommand"}


@driver("gripper_command", settings=Settings)
class GripperCommand(ActionClientDriver):
    """Driver of one gripper behind a gripper controller."""

    package = "control_msgs"

    @property
    def type_name(self) -> str:
        return TYPES[self.settings.type]

    def mover(self, devices: Sequence[Robot]) -> Machine:
        return machine(devices, self.settings)

    def listen(self, node: Any) -> None:
        listen_to_joints(node, self.settings.joint_states, self.see)

    def goal(self, action: Any, goal: Width) -> Any:
        message = action.Goal()
        if self.settings.type == "single":
            message.command.position, message.command.max_effort = goal.position, goal.effort
        else:
            message.command.name, message.command.position = [goal.joint], [goal.position]
            message.command.effort = [goal.effort] if goal.effort else []
        return message

    def end(self, result: Any) -> dict[str, Any]:
        return {"stalled": result.stalled}
