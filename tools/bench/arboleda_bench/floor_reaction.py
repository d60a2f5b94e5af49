"""A bare node that walks a cell's robots through a task: callbacks publish messages made beforehand.

It hears the topics that the orchestrator hears, has its publishers and its executor, and asks no more than
whether the robot stands where it was sent: no node that waits for the robots can do with less.
"""

from __future__ import annotations

from functools import partial

from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, UInt8

from arboleda.drivers import Command, FollowPath, MoveJoints, Robot
from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import Cell, PlantModel
from arboleda_ros import convert, qos

from . import brain, steps
from .walker import Walker

NEAR = 1e-3  # rad or m; goals of the benchmarks' plants are further apart in their first coordinate
Ready = tuple[Publisher, object, str, float | None]  # a message, its robot, and where that is to arrive


class BareNode(Walker[Ready]):
    """One cell's robots, step by step."""

    def __init__(self, node: Node, model: PlantModel, cell: Cell) -> None:
        voices = brain.voices(node, cell)
        ready = [
            (voices[step.robot, type(step)], convert.command_message(step), step.robot, _goal(cell, step))
            for step in steps.storage(cell)
        ]
        super().__init__(ready, model.timing.dwell_s)
        self._effector_s = model.timing.effector_settle_s + model.timing.dwell_s
        self._robot, self._goal = "", 0.0  # which one moves, and where to
        self._state = {robot.name: 0 for robot in cell.robots}
        self._at = {robot.name: 0.0 for robot in cell.robots}
        for robot in cell.robots:
            self._hear(node, robot)
        brain.on_task(node, cell, self.task)

    def publish(self, step: Ready) -> None:
        voice, message, robot, goal = step
        if goal is not None:
            self._robot, self._goal = robot, goal
        voice.publish(message)
        if goal is None:
            self.go_on_after(self._effector_s)

    def _hear(self, node: Node, robot: Robot) -> None:
        name, joints = robot.name, robot.joint_states.topic
        node.create_subscription(UInt8, f"{name}/motion_state", partial(self._on_state, name), qos.COMMAND)
        node.create_subscription(JointState, joints, partial(self._on_joints, name), qos.SENSOR)
        if isinstance(robot, Arm):
            node.create_subscription(Bool, f"{name}/piece_detected", lambda _: None, qos.SENSOR)
            node.create_subscription(UInt8, f"{name}/start", lambda _: None, qos.COMMAND)

    def _on_state(self, robot: str, message: UInt8) -> None:
        self._state[robot] = message.data
        self._look(robot)

    def _on_joints(self, robot: str, message: JointState) -> None:
        self._at[robot] = message.position[0]
        self._look(robot)

    def _look(self, robot: str) -> None:
        if robot == self._robot and self._state[robot] == 0 and abs(self._at[robot] - self._goal) < NEAR:
            self._robot = ""
            self.go_on()


def _goal(cell: Cell, step: Command) -> float | None:
    """The first coordinate of a move's end; None for a step that is no move."""
    return steps.end(cell, step)[0] if isinstance(step, FollowPath | MoveJoints) else None


if __name__ == "__main__":
    brain.stand("floor", BareNode)
