"""Report in `/diagnostics` of a process that waits to lead a plant."""

from __future__ import annotations

import socket
from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.node import Node

from arboleda_ros import qos, statuses
from arboleda_ros.port import NAMED


class StandbyVoice:
    """Node `standby`, there while the process waits; it needs no executor."""

    def __init__(self, context: Context) -> None:
        self._node = Node("standby", context=context)
        self._publisher = self._node.create_publisher(DiagnosticArray, "/diagnostics", qos.COMMAND)
        namespace = self._node.get_namespace().strip("/")
        name = f"standby on {socket.gethostname()}"
        self._name = f"{NAMED}{namespace}/{name}" if namespace else f"{NAMED}{name}"

    def say(self, level: int, sentence: str, values: Mapping[str, str]) -> None:
        """Publish the state of the waiting process."""
        status = statuses.diagnostic(self._name, "standby", level, sentence, values)
        message = DiagnosticArray(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def close(self) -> None:
        """End the node: the process no longer waits."""
        self._node.destroy_node()
