"""Commands that boards accepted, as the bridge tells ROS 2: `python -m arboleda_kills.hosts.watch ROBOT...`.

It prints a line of JSON for each id that a robot's `status` names newly as accepted, until its input ends. An
id begins with the number of the start of the plant that gave it: the lines show which leader moved what.
"""

from __future__ import annotations

import json
import sys
import threading
from functools import partial

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.executors import ExternalShutdownException
from rclpy.qos import QoSProfile

from ..steady import unix_s

DEPTH = 100


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("watch")
    accepted: dict[str, str] = {}

    def hear(robot: str, message: DiagnosticStatus) -> None:
        id = next((pair.value for pair in message.values if pair.key == "accepted"), "")
        if id and accepted.get(robot) != id:
            accepted[robot] = id
            print(json.dumps({"at": unix_s(), "robot": robot, "id": id}), flush=True)

    for robot in sys.argv[1:]:
        node.create_subscription(
            DiagnosticStatus,
            f"{robot}/status",
            partial(hear, robot),
            QoSProfile(depth=DEPTH),
        )
    threading.Thread(target=_end_with_input, daemon=True).start()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        return


def _end_with_input() -> None:
    sys.stdin.read()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
