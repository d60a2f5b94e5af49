"""Robots that speak ROS 2 themselves: they report their joints and `motion_state`, and keep every moment."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import UInt8

from arboleda.drivers import Command, FollowPath, MotionState, MoveJoints, Report, Robot, Stop
from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import APART_S, Cell, PlantModel
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.hop import PLAIN
from arboleda_ros import convert, qos
from arboleda_ros.robot_publisher import JointsMessage

from . import steps
from .clockwork import Clockwork, now
from .moments import Moment

DECLARED: dict[str, Any] = {
    "link": "ros",
    "evidence": "joints",
    "assume_homed": True,
}  # what the plant file says of them
TELEMETRY_S = 0.1


class Robots:
    """Plays every robot of a plant with `link: ros` and `evidence: joints`.

    A move takes `move_s()`; `moments` has what happened in each cell, in order. The mobile robots stand
    where their last task ended.
    """

    def __init__(self, node: Node, model: PlantModel, move_s: Callable[[], float]) -> None:
        self.moments: dict[str, list[Moment]] = {cell.name: [] for cell in model.cells}
        self._clockwork = Clockwork()
        self._bodies = [
            Body(node, cell, robot, self._clockwork, move_s, self.moments[cell.name])
            for cell in model.cells
            for robot in cell.robots
        ]

    @property
    def missing(self) -> list[str]:
        """The topics of robots to which nobody else is connected yet."""
        return [topic for body in self._bodies for topic in body.missing]

    def start(self) -> None:
        self._clockwork.start()
        for body in self._bodies:
            self._clockwork.every(TELEMETRY_S, body.tell)

    def stop(self) -> None:
        self._clockwork.stop()


class Body:
    """One robot: it stands, or moves and is at its goal when the time is over."""

    def __init__(
        self,
        node: Node,
        cell: Cell,
        robot: Robot,
        clockwork: Clockwork,
        move_s: Callable[[], float],
        moments: list[Moment],
    ) -> None:
        self._node = node
        self._layout = StorageLayout(cell)
        self._robot = robot
        self._clockwork = clockwork
        self._move_s = move_s
        self._moments = moments
        self._moving: Command | None = None
        self._proven_from = math.inf  # who hears its last node from then on knows that the drive has ended
        self._state = node.create_publisher(UInt8, f"{robot.name}/motion_state", qos.COMMAND)
        self._joints = node.create_publisher(JointState, robot.joint_states.topic, qos.COMMAND)
        self._position = JointsMessage(robot)
        self._here = self._state_at(_resting_place(cell, robot))
        self._commanded: list[str] = []
        for kind in convert.commands_of(robot):
            topic = f"{robot.name}/{PLAIN[kind]}"
            self._commanded.append(topic)
            node.create_subscription(convert.message_type(kind), topic, self._hearing(kind), qos.COMMAND)

    @property
    def missing(self) -> list[str]:
        deaf = [voice.topic for voice in (self._state, self._joints) if not voice.get_subscription_count()]
        return deaf + [topic for topic in self._commanded if not self._node.count_publishers(topic)]

    def tell(self) -> None:
        """Publish the robot's place."""
        at = now()
        self._joints.publish(self._here)
        if at >= self._proven_from:
            self._prove(at)

    def _prove(self, at: float) -> None:
        """Note a drive's end once more, now that its last node, which proves the end, is reported."""
        self._proven_from = math.inf
        last = self._moments[-1]
        if last.ended and last.command.robot == self._robot.name:
            self._moments.append(replace(last, at=at))

    def _hearing(self, kind: type[Command]) -> Callable[[Any], None]:
        def heard(message: Any) -> None:
            at = now()
            self._obey(at, convert.command(kind, self._robot, message))

        return heard

    def _obey(self, at: float, command: Command) -> None:
        if isinstance(command, Stop):
            self._halt()
            return
        self._moments.append(Moment(at=at, command=command, ended=False))
        self._proven_from = math.inf
        if isinstance(command, MoveJoints | FollowPath):
            self._moving = command
            self._state.publish(UInt8(data=int(MotionState.MOVING)))
            self._clockwork.after(self._move_s() - (now() - at), lambda: self._arrive(command))

    def _arrive(self, command: Command) -> None:
        if self._moving is not command:
            return
        self._moving = None
        self._here = self._state_at(_goal(command))
        last = isinstance(command, MoveJoints) and self._layout.arm.motion.reached(
            command.q, self._layout.home.joints
        )
        self._joints.publish(self._here)
        stopped = UInt8(data=int(MotionState.STOPPED))
        at = now()
        self._moments.append(Moment(at=at, command=command, ended=True, last=last))
        self._state.publish(stopped)
        if isinstance(command, FollowPath):
            self._proven_from = at + APART_S

    def _halt(self) -> None:
        self._moving = None
        self._state.publish(UInt8(data=int(MotionState.STOPPED)))

    def _state_at(self, place: Sequence[float] | int) -> JointState:
        """The joint states for a place: joints of an arm, or a node of the grid."""
        if isinstance(self._robot, Arm) and not isinstance(place, int):
            said = Report(at=0.0, robot=self._robot.name, q=self._robot.motion.quantised(tuple(place)))
        else:
            assert isinstance(place, int)
            said = Report(at=0.0, robot=self._robot.name, node=place)
        message = self._position.of(said, self._node.get_clock())
        assert message is not None
        return message


def _resting_place(cell: Cell, robot: Robot) -> Sequence[float] | int:
    return cell.paths[steps.PATH].nodes[-1] if isinstance(robot, Mobile) else cell.reach[robot.name].home.q


def _goal(command: Command) -> Sequence[float] | int:
    if isinstance(command, FollowPath):
        return command.nodes[-1]
    assert isinstance(command, MoveJoints)
    return command.q
