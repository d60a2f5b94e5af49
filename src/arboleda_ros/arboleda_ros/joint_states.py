"""Joint states for the drivers of ros2_control."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.drivers.ros_action.joints import JointsSeen

from .action_client import stamp_of


def listen_to_joints(node: Any, topic: str, see: Callable[[JointsSeen], None]) -> None:
    """Have every joint state of a topic seen."""
    from sensor_msgs.msg import JointState

    from .qos import SENSOR

    def hear(message: Any) -> None:
        names, positions = tuple(message.name), tuple(message.position)
        see(JointsSeen(names=names, positions=positions, stamp=stamp_of(message)))

    node.create_subscription(JointState, topic, hear, SENSOR)
