"""A bare node in the orchestrator's place between two hops of the bridge: status in, next command out.

It hears `/{robot}/status`, reads in it whether the last command is done, and publishes the next from that
callback, labelled as the bridge wants it: with the epoch of the plant that beats.
"""

from __future__ import annotations

from itertools import count
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import Float32MultiArray, UInt8, UInt32

from arboleda.drivers import SetEffector
from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.wire.hop import COMMAND
from arboleda_ros import convert, qos

from . import brain, steps
from .walker import Walker

READY_S = 0.05
STOPPED = "0"
Ready = tuple[Publisher, Any, str | None]  # a message, and what the effector then reports


class Echo(Walker[Ready]):
    """One cell's robots, step by step; it takes tasks once the bridge hears it and its robots are there."""

    def __init__(self, node: Node, model: PlantModel, cell: Cell) -> None:
        self._voices = {
            robot.name: node.create_publisher(Float32MultiArray, f"{robot.name}/{COMMAND}", qos.COMMAND)
            for robot in cell.robots
        }
        robots = {robot.name: robot for robot in cell.robots}
        ready = [
            (
                self._voices[step.robot],
                convert.labelled_message(robots[step.robot], step, copied=False),
                _effector(step),
            )
            for step in steps.storage(cell)
        ]
        super().__init__(ready, model.timing.dwell_s)
        self._dwell_s = model.timing.dwell_s
        self._epoch = 0
        self._number = count(1)
        self._awaited = ("", "")  # a key of the status, and the value that ends the step
        self._silent = {robot.name for robot in cell.robots}
        for robot in cell.robots:
            name = f"{robot.name}/status"
            node.create_subscription(DiagnosticStatus, name, self._on_status, qos.COMMAND)
            if isinstance(robot, Arm):
                node.create_subscription(UInt8, f"{robot.name}/start", lambda _: None, qos.COMMAND)
        node.create_subscription(UInt32, "plant/heartbeat", self._on_beat, qos.COMMAND)
        self._opening = node.create_timer(READY_S, lambda: self._open(node, cell))

    def publish(self, step: Ready) -> None:
        voice, message, effector = step
        label = f"{self._epoch}-{next(self._number)}"
        message.layout.dim[0].label = f"id={label}"
        self._awaited = ("done", label) if effector is None else ("effector", effector)
        voice.publish(message)

    def _on_status(self, message: DiagnosticStatus) -> None:
        said = {pair.key: pair.value for pair in message.values}
        if said.get("state") != STOPPED:
            return
        self._silent.discard(message.name.rpartition(" ")[2])
        key, value = self._awaited
        if key and said.get(key) == value:
            self._awaited = ("", "")
            if key == "effector":
                self.go_on_after(self._dwell_s)
            else:
                self.go_on()

    def _on_beat(self, message: UInt32) -> None:
        self._epoch = message.data

    def _open(self, node: Node, cell: Cell) -> None:
        heard = all(voice.get_subscription_count() for voice in self._voices.values())
        if heard and self._epoch and not self._silent:
            self._opening.cancel()
            brain.on_task(node, cell, self.task)


def _effector(step: object) -> str | None:
    """The effector's value in a status once it has switched; None for a step that is no effector command."""
    return str(step.on).lower() if isinstance(step, SetEffector) else None


if __name__ == "__main__":
    brain.stand("echo", Echo)
