"""The floor of `idle`: a bare node that hears what the orchestrator hears, and does nothing about it."""

from __future__ import annotations

import signal
import sys
import time
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String, UInt8

from arboleda.kinds.arm import Arm
from arboleda.plant_file.loader import load

DEPTH = QoSProfile(depth=10)  # reliable and volatile, as commands and reports are
SPIN_S = 1.0
POLL_S = 0.05


def main(plant: str) -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)
    rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
    node = Node("floor")
    node.create_subscription(String, "task_request", _nothing, DEPTH)
    robots = load(Path(plant)).robots.values()
    for robot in robots:
        node.create_subscription(DiagnosticStatus, f"{robot.name}/status", _nothing, DEPTH)
        if isinstance(robot, Arm):
            node.create_subscription(UInt8, f"{robot.name}/start", _nothing, DEPTH)
    try:
        while not all(node.count_publishers(f"{robot.name}/status") for robot in robots):
            time.sleep(POLL_S)
        print("every robot is found", flush=True)
        _spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def _spin(node: Node) -> None:
    executor = _executor()
    executor.add_node(node)
    while rclpy.ok():
        executor.spin_once(timeout_sec=SPIN_S)


def _executor() -> Executor | Any:
    """An executor of the same kind as the orchestrator's."""
    try:
        from rclpy.experimental import EventsExecutor

        return EventsExecutor()
    except ImportError:
        return SingleThreadedExecutor()


def _nothing(_message: Any) -> None: ...


if __name__ == "__main__":
    main(sys.argv[1])
