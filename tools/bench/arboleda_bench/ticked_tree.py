"""The storage recipe as many write it: a py_trees tree that a timer ticks; its leaves look at the last state.

Every leaf sends its command when it begins and then reads, tick by tick, the last report of its robot.
Nothing is kept, no deadline is watched: it is the least that a ticked tree does.
"""

from __future__ import annotations

import sys
import time

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_msgs.msg import UInt8

from arboleda.drivers import FollowPath, MoveJoints, Robot, SetEffector
from arboleda.model.plant_model import Cell, PlantModel
from arboleda_ros import convert, qos

from . import brain, steps

NEAR = 1e-3  # rad or m


class Heard:
    """The last report of a robot."""

    def __init__(self, node: Node, robot: Robot) -> None:
        self.state = 0
        self.position: tuple[float, ...] = ()
        node.create_subscription(UInt8, f"{robot.name}/motion_state", self._on_state, qos.COMMAND)
        node.create_subscription(JointState, robot.joint_states.topic, self._on_joints, qos.SENSOR)

    def _on_state(self, message: UInt8) -> None:
        self.state = message.data

    def _on_joints(self, message: JointState) -> None:
        self.position = tuple(message.position)


class Move(Behaviour):
    """Sends a goal, then is RUNNING until the robot stands there."""

    def __init__(
        self, name: str, voice: Publisher, message: object, heard: Heard, goal: tuple[float, ...]
    ) -> None:
        super().__init__(name)
        self.voice = voice
        self.message = message
        self.robot = heard
        self.goal = goal

    def initialise(self) -> None:
        self.voice.publish(self.message)

    def update(self) -> Status:
        there = all(abs(at - goal) < NEAR for at, goal in zip(self.robot.position, self.goal, strict=True))
        return Status.SUCCESS if there and self.robot.state == 0 else Status.RUNNING


class Send(Behaviour):
    """Sends a message that nothing answers."""

    def __init__(self, name: str, voice: Publisher, message: object) -> None:
        super().__init__(name)
        self.voice = voice
        self.message = message

    def update(self) -> Status:
        self.voice.publish(self.message)
        return Status.SUCCESS


class Pause(Behaviour):
    """Is RUNNING for so many seconds."""

    def __init__(self, name: str, seconds: float) -> None:
        super().__init__(name)
        self.seconds = seconds
        self.until = 0.0

    def initialise(self) -> None:
        self.until = time.monotonic() + self.seconds

    def update(self) -> Status:
        return Status.SUCCESS if time.monotonic() >= self.until else Status.RUNNING


class Ticked:
    """A cell's tree and its timer; the third word of the command line is how often per second it ticks."""

    def __init__(self, node: Node, model: PlantModel, cell: Cell) -> None:
        self._waiting = 0
        self._tree = _storage(node, model, cell)
        brain.on_task(node, cell, self._task)
        node.create_timer(1 / float(sys.argv[3]), self._tick)

    def _task(self) -> None:
        self._waiting += 1

    def _tick(self) -> None:
        if not self._waiting:
            return
        self._tree.tick_once()
        if self._tree.status is Status.SUCCESS:
            self._waiting -= 1


def _storage(node: Node, model: PlantModel, cell: Cell) -> Sequence:
    timing, voices = model.timing, brain.voices(node, cell)
    heard = {robot.name: Heard(node, robot) for robot in cell.robots}
    leaves: list[Behaviour] = [Pause("system start", timing.dwell_s)]
    for step in steps.storage(cell):
        voice, message = voices[step.robot, type(step)], convert.command_message(step)
        if isinstance(step, SetEffector):
            settled = Pause("settle", timing.effector_settle_s + timing.dwell_s)
            leaves += [Send("effector", voice, message), settled]
        else:
            assert isinstance(step, FollowPath | MoveJoints)
            goal = steps.end(cell, step)
            leaves.append(Move("move", voice, message, heard[step.robot], goal))
    return Sequence("storage", memory=True, children=leaves)


if __name__ == "__main__":
    brain.stand("ticked_tree", Ticked)
