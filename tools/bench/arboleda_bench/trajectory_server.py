"""An action server that has reached every goal at once, and joint states 200 times a second: a process."""

from __future__ import annotations

from typing import Any

import rclpy
from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionServer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState

ACTION = "joint_trajectory_controller/follow_joint_trajectory"
STATE_S = 0.005


class Server:
    def __init__(self, node: Node) -> None:
        self._node, self._names, self._q = node, [f"joint{number}" for number in range(1, 7)], [0.0] * 6
        self._states = node.create_publisher(JointState, "joint_states", 10)
        node.create_timer(STATE_S, self._speak, callback_group=ReentrantCallbackGroup())
        self._server = ActionServer(node, FollowJointTrajectory, ACTION, self._execute)

    def _execute(self, handle: Any) -> Any:
        trajectory = handle.request.trajectory
        self._names, self._q = list(trajectory.joint_names), list(trajectory.points[-1].positions)
        handle.succeed()
        return FollowJointTrajectory.Result()

    def _speak(self) -> None:
        state = JointState(name=self._names, position=self._q)
        state.header.stamp = self._node.get_clock().now().to_msg()
        self._states.publish(state)


def main() -> None:
    rclpy.init()
    node = Node("trajectory_server")
    server = Server(node)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        del server


if __name__ == "__main__":
    main()
