"""Joint states for the drivers of ros2_control."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda_drivers.ros_action.action_client import stamp_of
from arboleda_drivers.ros_action.joints import JointStateEvent


def listen_to_joints(node: Any, topic: str, see: Callable[[JointStateEvent], None]) -> None:
    """Subscribe to a topic of joint states, and pass each one on."""
    from sensor_msgs.msg import JointState

    from arboleda_ros.qos import SENSOR

    def hear(message: Any) -> None:
        names, positions = tuple(message.name), tuple(message.position)
        see(JointStateEvent(names=names, positions=positions, stamp=stamp_of(message)))

    node.create_subscription(JointState, topic, hear, SENSOR)
